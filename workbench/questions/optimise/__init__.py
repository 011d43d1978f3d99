"""Which wheel is the best within limits? (``workbench optimise``)"""
