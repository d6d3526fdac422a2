"""Malformed input to every command of the command line."""
