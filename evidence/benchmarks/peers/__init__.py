"""One adapter for each of the other programs: a process of its own, on the mesh that Evolvent gets."""
