"""Paths that clear pockets with a bounded engagement angle."""
