"""Values that are expensive to compute, kept in files between calls: the cache."""
