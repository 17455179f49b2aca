"""Short trees: the Euclidean Steiner tree of each hyperedge, nearly."""
