"""Numerical ideas that several rooms use, each once: roots, cubics, Runge-Kutta formulas, robust spread.

Compiled code cannot be handed a function, so a search or a step asks its caller to evaluate: it says where, takes the
value, and says where next.
"""
