"""Shared inference: fits, intervals and comparisons that every channel uses."""
