"""Root strength of gears."""
