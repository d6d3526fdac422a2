"""Results of gears from Python, which draw and write themselves."""
