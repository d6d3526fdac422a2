"""A scene from start to finish."""
