"""The scene as bytes: glTF, pictures."""
