"""Run time against error, what each skip saves, and whether error bars hold."""
