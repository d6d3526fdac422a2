"""Involute gears and gear pairs: geometry, limits, transverse profile, exact flank.

Of gear and pair each: `*_geometry` has the data and what follows from them, `*_limits` the checks, `gear` and `pair`
the checked class that the program works with.
"""
