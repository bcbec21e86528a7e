"""Verification of posted text against the part, and the material that a program leaves."""
