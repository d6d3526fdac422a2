"""Plan of a study: its file, its parameters and its scenes."""
