"""Static condensation of a body's stiffness onto the functionals that couple it with contact."""
