"""Error bars of a run's figures."""
