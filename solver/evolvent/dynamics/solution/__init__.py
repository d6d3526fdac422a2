"""Excitation and vibration of gear pairs from Python, and oscillators on a given mesh."""
