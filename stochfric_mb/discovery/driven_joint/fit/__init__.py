"""Fits of a joint's friction and of the mechanism's numbers to its balances of forces."""
