"""Runs behind the figures of pages, and the files that keep these."""
