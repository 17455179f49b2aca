"""Hyperedges as Bezier curves: the paper's CURVES, and what keeps hyperedges apart."""
