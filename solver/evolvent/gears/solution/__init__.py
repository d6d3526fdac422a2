"""Solved positions and pitches, certified: functions for Python users of gears."""
