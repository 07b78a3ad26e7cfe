"""Which effects a joint lacks: candidates, selection, confounding, and the verdict with its numbers."""
