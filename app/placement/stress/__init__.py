"""Places by stress: what belongs together stands together. Arrays in, arrays out."""
