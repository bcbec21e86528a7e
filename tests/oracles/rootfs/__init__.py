"""Root file systems with foreign programs: what they hold, how they are built and entered. See roots.py."""
