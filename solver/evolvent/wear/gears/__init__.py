"""A gear pair that wears."""
