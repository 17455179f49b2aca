"""Other people's documents, to and from programs."""
