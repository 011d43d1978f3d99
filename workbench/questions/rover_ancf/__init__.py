"""How does the rover on six ANCF tires move beside the one on brush tires, figure by figure of the thesis?"""
