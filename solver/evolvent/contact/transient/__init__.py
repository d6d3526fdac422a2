"""Contact of bodies with inertia, over time."""
