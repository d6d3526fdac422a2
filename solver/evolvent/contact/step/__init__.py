"""One step of a contact problem: its contact system, its solution, and the checks on it."""
