"""Friction at contacts: steering MuJoCo's own solver, or an explicit force, from step to step."""
