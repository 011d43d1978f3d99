"""How does the rover on brush tires go through the thesis' scenarios?"""
