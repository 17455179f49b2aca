"""Routing by relaxation: elastic chains of beads that push each other apart."""
