"""Elimination of a body onto the functionals that couple it with contact."""
