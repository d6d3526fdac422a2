"""The sector meshes of a scene, and how fine they are."""
