"""The contact of a gear pair at one position."""
