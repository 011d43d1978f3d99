"""Is the moving ANCF wheel's energy accounted for, dropped and riding over a half-round?"""
