"""Verification problems of contact with friction: partial slip, rolling, sliding."""
