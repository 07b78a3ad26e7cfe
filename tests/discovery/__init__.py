"""Tests of discovery: hidden effects planted by a generator that shares no code with the package."""
