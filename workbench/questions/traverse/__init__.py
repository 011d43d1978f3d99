"""Does the rover drive the two kilometres between two samples over rocks, and what do its wheels carry on the way?"""
