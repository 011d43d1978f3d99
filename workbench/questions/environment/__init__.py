"""How does temperature change stiffness and strength?"""
