"""Archard wear of any contact problem: contact states, mesh motion, blocks of cycles, wear coefficients from tests.

The public names; each is loaded with its module at the first use.
"""
