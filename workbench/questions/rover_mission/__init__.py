"""Which requirements of the mission does the rover meet on each kind of tire, with what torque, and what ends it?"""
