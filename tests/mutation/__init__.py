"""The judge is judged: seeded defects must be found where they are, sound programs must pass."""
