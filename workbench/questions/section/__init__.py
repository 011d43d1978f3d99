"""Does the planar section model follow the solid one?"""
