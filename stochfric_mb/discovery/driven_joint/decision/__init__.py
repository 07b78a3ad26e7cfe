"""Which effects a joint lacks: selection, what speaks against it, and the verdict with its numbers."""
