"""Transient contact of a scene, from start to finish."""
