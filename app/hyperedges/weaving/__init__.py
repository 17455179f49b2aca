"""Curves that keep clear of each other: plans seen from above, storeys, ways around, courses."""
