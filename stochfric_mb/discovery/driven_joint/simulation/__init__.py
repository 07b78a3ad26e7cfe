"""A joint simulated again: closed loop, engines, scores, and the augmented scenario."""
