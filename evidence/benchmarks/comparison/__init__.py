"""Round contacts solved by Evolvent and by other programs on the same meshes."""
