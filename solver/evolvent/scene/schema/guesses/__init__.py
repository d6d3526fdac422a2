"""What was meant by an unknown key or a value that is not allowed."""
