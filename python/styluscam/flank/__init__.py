"""Flank milling of ruled surfaces: rails, and the positions of a tool along the strip between them."""
