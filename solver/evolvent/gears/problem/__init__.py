"""A gear pair under load as plain data: gears, materials, torque, mesh settings and what is computed in full."""
