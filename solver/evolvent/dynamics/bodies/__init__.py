"""Gear bodies that give way, as a small system: a few static shapes of each gear with their mass and stiffness."""
