"""HTTP: routes, problems, negotiation. Nothing else knows of it."""
