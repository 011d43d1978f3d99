"""At which load does a part begin to yield?"""
