"""How long the time steps of a gear pair are, and what goes on from one length to another."""
