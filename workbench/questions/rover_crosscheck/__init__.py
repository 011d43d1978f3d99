"""Do the rover's fitted ANCF tires follow the continuum's curves at every orientation of the wheel?"""
