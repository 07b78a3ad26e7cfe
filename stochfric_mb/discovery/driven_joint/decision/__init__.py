"""Which effects a joint lacks: candidates, selection, scatter, confounding, and the verdict with its numbers."""
