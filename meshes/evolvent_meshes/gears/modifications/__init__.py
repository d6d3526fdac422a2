"""Modifications of a flank: their amounts, and the depth that they have at a point."""
