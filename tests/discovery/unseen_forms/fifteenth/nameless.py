"""Effects that no name describes."""
