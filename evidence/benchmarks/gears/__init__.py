"""The cost of gear pairs: a position, a pitch, their growth, and what each skip saves."""
