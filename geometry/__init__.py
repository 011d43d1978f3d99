"""The wheel as numbers, its mesh of hexahedra, the checks of that mesh and its files."""
