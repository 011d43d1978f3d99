"""Numbers with a rule: what passes, and where the rule comes from."""
