"""How exact is the multibody engine for its work, on the IFToMM problems A01 to A03?"""
