"""ancf_reduced."""
