"""Equilibrium of the condensed contact system: SNES, tangent, sensitivities."""
