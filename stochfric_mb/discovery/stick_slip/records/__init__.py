"""Records of a belt-box: cleaned, cut into stick and slip, and reduced to the features of each slip."""
