"""Hexahedra and quadrangles: shape functions, integration, residual and tangent."""
