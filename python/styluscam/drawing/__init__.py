"""Pictures of parts, paths and tools."""
