"""Slow work, away from the event loop."""
