"""Archard's wear on contact solutions, in blocks of cycles, on a mesh that follows."""
