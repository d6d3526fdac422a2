"""The scene file: read, checked, completed with defaults."""
