"""The tool on the surface: positions, and the offset surface as a mesh."""
