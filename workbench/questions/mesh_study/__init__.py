"""How well does the mesh know the load?"""
