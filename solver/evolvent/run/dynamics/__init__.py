"""The dynamics of a scene, from start to finish."""
