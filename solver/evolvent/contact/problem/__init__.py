"""What a contact problem states, and its bodies condensed."""
