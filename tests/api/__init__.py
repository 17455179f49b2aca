"""HTTP, against the real service."""
