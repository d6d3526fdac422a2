"""Mesh of one tooth sector: its transverse section, swept along the helix."""
