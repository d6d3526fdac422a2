"""Verification problems of contact with inertia, over time."""
