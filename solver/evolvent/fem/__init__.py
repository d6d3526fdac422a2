"""Elastic bodies: mesh, material, supports, loads, contact surfaces, stress."""
