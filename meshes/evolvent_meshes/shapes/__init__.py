"""Meshes of the verification shapes."""
