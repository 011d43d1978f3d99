"""How far do the curves of a wheel vary with what is not exactly known of it?"""
