"""What no effect of the vocabulary describes."""
