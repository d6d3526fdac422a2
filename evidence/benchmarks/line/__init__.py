"""Line contact beside the resolved contact."""
