"""A step of a motion in time, and the energy that it keeps."""
