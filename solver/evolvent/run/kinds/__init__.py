"""The computations of a scene, a file for each."""
