"""Positions of a gear pair: friction history, deflected flanks, the pitch."""
