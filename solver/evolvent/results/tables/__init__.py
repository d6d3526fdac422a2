"""summary.json, positions.csv, teeth.csv, and the warnings that stand beside them."""
