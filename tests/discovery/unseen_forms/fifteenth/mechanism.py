"""Effects of the mechanism."""
