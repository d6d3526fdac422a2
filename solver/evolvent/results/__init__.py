"""A run's results as a gear engineer reads them."""
