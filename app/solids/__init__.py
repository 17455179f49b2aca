"""Items as meshes, and how much room they take."""
