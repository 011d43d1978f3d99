"""How far does the load depend on the contact penalty?"""
