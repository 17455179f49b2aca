"""What a reader sees of a layout, in numbers."""
