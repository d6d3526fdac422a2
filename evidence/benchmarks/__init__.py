"""Run time against error, and what determines both."""
