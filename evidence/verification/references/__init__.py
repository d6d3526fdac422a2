"""Exact and independent solutions that the verification problems are compared with."""
