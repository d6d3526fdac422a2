"""Pairing of two surfaces: candidates, segments, points and their partners."""
