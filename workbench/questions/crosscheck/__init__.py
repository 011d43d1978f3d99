"""Does another code, CalculiX, find the same loads on our mesh?"""
