"""A test set of stick-slip records whose forms were chosen without sight of the method; shares no code with the package."""
