"""Pictures of root stress."""
