"""Names on trial: what they explain of the runs that they come from, and what held-out runs say of them."""
