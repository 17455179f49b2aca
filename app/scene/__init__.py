"""What there is to see: nodes, materials, palette, lights, camera."""
