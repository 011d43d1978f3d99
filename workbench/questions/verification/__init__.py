"""Do finite elements and ANCF plates agree with known answers, solved by the same calls as the wheel?"""
