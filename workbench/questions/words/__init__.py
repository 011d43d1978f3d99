"""What do the thesis' words say of the reference wheel, and which of them does this wheel satisfy?"""
