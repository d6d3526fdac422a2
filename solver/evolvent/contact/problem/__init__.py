"""Definition of a contact problem, and its condensed bodies."""
