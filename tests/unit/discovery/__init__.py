"""Tests of discovery's parts, each on data made by its own formula."""
