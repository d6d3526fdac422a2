"""Scene file: reading, validation and defaults."""
