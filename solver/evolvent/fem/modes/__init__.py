"""Inertia of elastic bodies: mass matrix, natural modes."""
