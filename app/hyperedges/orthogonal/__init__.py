"""Constructed curves of programs in layers: level, and upright in channels, with round corners."""
