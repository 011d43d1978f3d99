"""How far are two curves from each other? (``workbench compare``)"""
