"""Results of a run: archive, derived figures, error bars, tables, fields and pictures."""
