"""Curves as tubes: frames along them, swept circles, and the paper's pairs of patches."""
