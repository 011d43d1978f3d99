"""Does the ANCF tire's load depend on its number of plates?"""
