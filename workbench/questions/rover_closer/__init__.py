"""What do the rover's ANCF tires look like closely: pressure, strain, vibration beside the brush tire, animation?"""
