"""Directed programs in layers: ranks, order, rows and channels. Arrays in, arrays out."""
