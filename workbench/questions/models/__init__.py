"""How far do the reduced models and the user's curves follow the average continuum curve?"""
