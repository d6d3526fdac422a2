"""The sector meshes of a gear pair, and how fine they are."""
