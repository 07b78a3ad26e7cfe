"""Tests of discovery at driven joints."""
