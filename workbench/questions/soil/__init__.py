"""What does the wheel do on soil, and how far do the soil's laws carry?"""
