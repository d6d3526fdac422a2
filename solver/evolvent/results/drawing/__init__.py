"""Style, tooth names, files and off-screen rendering common to all pictures."""
