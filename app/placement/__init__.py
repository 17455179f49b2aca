"""Items without a place get one."""
