"""Smooth shapes that effects may follow: courses along a quantity, and waves that come back."""
