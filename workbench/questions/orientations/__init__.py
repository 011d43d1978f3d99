"""How does the load vary around the wheel?"""
