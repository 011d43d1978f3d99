"""Does the continuum model find what others published of their wheels, as far as both are known?"""
