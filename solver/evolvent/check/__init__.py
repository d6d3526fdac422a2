"""Reports on a scene before it is computed."""
