"""Matrices of settings, and independence of the parameters of Nitsche's method."""
