"""Contact problems solved: steps, sweeps, reactions, fields."""
