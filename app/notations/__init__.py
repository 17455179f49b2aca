"""How kinds look: data files, and their loader."""
