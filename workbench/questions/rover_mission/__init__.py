"""Does the rover meet the mission's requirements on fitted ANCF tires, as on brush tires?"""
