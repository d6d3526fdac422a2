"""The keys of a scene file, and what is said of a wrong one."""
