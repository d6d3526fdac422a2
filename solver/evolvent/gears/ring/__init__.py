"""One condensed sector closed to the ring of all teeth."""
