"""What a study computes: its file, its parameters, its scenes."""
