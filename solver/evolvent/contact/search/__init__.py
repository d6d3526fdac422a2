"""Where two surfaces face each other."""
