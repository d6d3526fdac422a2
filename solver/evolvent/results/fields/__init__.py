"""Displacement, stress and pressure as fields, for ParaView."""
