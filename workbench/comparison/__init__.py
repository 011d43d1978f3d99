"""Results held against each other: distances, uncertainties, verdicts."""
