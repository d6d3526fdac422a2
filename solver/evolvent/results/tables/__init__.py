"""Tables of a run (summary.json, positions.csv, teeth.csv) and its warnings."""
