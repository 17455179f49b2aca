"""How far hyperedges are from each other and from items, proven."""
