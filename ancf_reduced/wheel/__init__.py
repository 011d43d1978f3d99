"""The wheel of a design as a network of thin ANCF plates: mesh, welds, ground, equilibria."""
