"""Natural modes of gears made of equal sectors."""
