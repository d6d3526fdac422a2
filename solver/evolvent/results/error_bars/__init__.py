"""Error bars of the engineering figures: the part of the mesh and the part of the spacing of positions."""
