"""Stability under stress: random scenes, a matrix of settings, independence of the method's parameters, faults."""
