"""Solved positions and pitches, certified: what a Python user of gears calls."""
