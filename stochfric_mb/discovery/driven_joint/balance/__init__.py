"""Records of a driven joint as balances of forces in weak form: what is left of the drive for friction."""
