"""A mass on the periodic, piecewise smooth force of a mesh with backlash: its steady states over the speed."""
