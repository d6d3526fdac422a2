"""Torsional vibration of a gear pair, excited by its mesh."""
