"""What outlives a process: programs with their revisions, jobs, results, keys."""
