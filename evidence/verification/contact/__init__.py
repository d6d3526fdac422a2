"""Verification problems of contact without friction."""
