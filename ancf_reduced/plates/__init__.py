"""Any network of fully parametrised ANCF plates: shape functions, mesh, energy, forces, tangents."""
