"""Suggestions for unknown keys and for values that are not allowed."""
