"""Elastic bodies: material, supports, loads, stiffness, contact surfaces, stress."""
