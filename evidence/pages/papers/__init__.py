"""Pages that hold a paper's pair against it, point by point."""
