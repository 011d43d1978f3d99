"""Did every run of the finite elements come to equilibrium, and on what mesh?"""
