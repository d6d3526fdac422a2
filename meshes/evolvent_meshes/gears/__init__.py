"""Gear and pair data, the transverse profile, the exact flank."""
