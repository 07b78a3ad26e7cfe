"""A net under changes of discovery: what it says of some eighty data sets, frozen, and a command that lists what moved."""
