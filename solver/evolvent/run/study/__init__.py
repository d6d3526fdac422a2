"""Studies over many scenes."""
