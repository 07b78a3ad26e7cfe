"""Which effect is meant: distinguished by simulation, checked on fit and held-out runs, or declined."""
