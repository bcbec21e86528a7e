"""The formats of part files by their endings, and the units of those that carry none."""

from __future__ import annotations

BREP_ENDINGS = (".step", ".stp", ".brep", ".brp", ".iges", ".igs")
MESH_ENDINGS = (".stl", ".obj", ".ply", ".3mf")
UNITLESS = (".stl", ".obj", ".ply")
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 0.001, "in": 25.4, "inch": 25.4, "ft": 304.8}
"""To mm."""
