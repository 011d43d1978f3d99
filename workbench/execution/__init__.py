"""Tasks run by workers, their results kept under the hash of all they depend on."""
