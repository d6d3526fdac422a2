"""Fine contact on a coarse body: the compliance of a coarse mesh, and of patches finely and coarsely meshed."""
