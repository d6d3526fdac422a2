"""Computing a scene from start to finish."""
