"""The verifier is tested: seeded defects must be found where they are, sound programs must pass."""
