"""Contact of any two elastic bodies."""
