"""What a gear pair's mesh does to its vibration: unloaded transmission error, force over deflection, stiffness."""
