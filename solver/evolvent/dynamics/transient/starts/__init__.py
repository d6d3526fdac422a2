"""The states in which a transient begins."""
