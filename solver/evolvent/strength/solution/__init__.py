"""Root stress and contact fatigue of gear pairs from Python."""
