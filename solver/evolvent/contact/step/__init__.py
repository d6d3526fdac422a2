"""One step of a contact problem: its contact system, its result, and the checks on it."""
