"""How does the study's ANCF tire carry load, and does it agree with what is known of the thesis'?"""
