"""What can be said of a scene before it is computed."""
