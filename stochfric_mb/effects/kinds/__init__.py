"""The effects themselves: one file each, named after its kind."""
