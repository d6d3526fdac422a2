"""Gears whose flanks are finer than their bodies: corrections by fine cells, strip by strip along the face."""
