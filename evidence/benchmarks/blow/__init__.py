"""A block that flies against another one, by Evolvent and by CalculiX, on one mesh with the same time steps."""
