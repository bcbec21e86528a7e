"""Advice before anything is planned: which tools suit a part, what they cannot reach, how long a plan takes."""
