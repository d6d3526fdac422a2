"""Root strength of a scene."""
