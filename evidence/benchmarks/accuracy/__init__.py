"""How often error bars contain the true error."""
