"""Pictures as they should look, and how near to them we are."""
