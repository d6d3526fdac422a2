"""Verification problems of gear pairs."""
