"""Discovery on velocity steps of a spring slider: constant friction, drift, dependence on speed, or memory."""
