"""Which effect is meant: told apart by simulation, checked on fit and held-out runs, or declined."""
