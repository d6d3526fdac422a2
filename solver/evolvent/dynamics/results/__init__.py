"""What is left of the dynamics of a pair: tables and pictures."""
