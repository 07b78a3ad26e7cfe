"""Rigs that are as believed: nothing is missing."""
