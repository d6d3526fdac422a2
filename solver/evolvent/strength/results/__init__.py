"""Tables of root stress."""
