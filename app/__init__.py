"""Tubeloom: programs with hyperedges, shown as smooth tubes in three dimensions."""

from importlib.metadata import version

__version__ = version("tubeloom")
