"""Wear: Archard's law on contact solutions, in blocks of cycles, on a mesh that follows."""
