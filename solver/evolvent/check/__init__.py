"""What is reported of a scene before it is computed."""
