"""Excitation of vibration by a gear mesh: unloaded transmission error, force over deflection, stiffness."""
