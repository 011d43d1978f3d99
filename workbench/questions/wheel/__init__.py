"""Does the mesh have the volume and the mass of the wheel that was designed?"""
