"""One adapter for each of the other programs. Each runs as a process of its own, on the mesh that Evolvent gets."""
