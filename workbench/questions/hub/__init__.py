"""What do elastic hubs, cone and impact springs add to the curve, one part after another?"""
