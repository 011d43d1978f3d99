"""How does the continuum wheel carry load, orientation by orientation, and did it come to equilibrium?"""
