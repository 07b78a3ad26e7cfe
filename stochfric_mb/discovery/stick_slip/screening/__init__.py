"""Which effects would explain what the model leaves in the slips: regression over hypotheses."""
