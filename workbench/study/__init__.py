"""Study files: sections, rules, units, and what the models get from them."""
