"""What changes as parameters of the study do? (``workbench sweep``)"""
