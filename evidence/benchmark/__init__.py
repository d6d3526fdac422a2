"""Run time against error, of Evolvent and of the programs that a user would take instead."""
