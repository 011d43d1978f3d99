"""Do thin ANCF plates of the wheel itself carry the solid model's load?"""
