"""How fast are the kernels beside their peers?"""
