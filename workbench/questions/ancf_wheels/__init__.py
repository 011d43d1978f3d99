"""How far is the ANCF wheel from the solid model all around, and on wheels other than the study's?"""
