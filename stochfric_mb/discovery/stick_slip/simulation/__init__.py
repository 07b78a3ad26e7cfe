"""Models of a belt-box in the making: simulated, fitted to forecasts, and scored on held-out runs."""
