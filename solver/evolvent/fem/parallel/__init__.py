"""MPI ranks, processor cores and memory."""
