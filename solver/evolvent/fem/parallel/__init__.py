"""Ranks, cores and memory."""
