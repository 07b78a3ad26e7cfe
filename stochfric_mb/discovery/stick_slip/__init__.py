"""Discovery on a belt-box that sticks and slips: records -> screening -> decision -> refit -> held-out runs -> result."""
