"""Gear pairs with inertia, over time."""
