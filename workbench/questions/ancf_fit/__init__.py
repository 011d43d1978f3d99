"""Can an ANCF tire be fitted to the average continuum curve?"""
