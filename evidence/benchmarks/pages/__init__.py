"""The page docs/benchmark.md and its figures, from the measured tables."""
