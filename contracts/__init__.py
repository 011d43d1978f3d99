"""What crosses between packages: errors, materials, frames, meshes, curves and records. numpy only."""
