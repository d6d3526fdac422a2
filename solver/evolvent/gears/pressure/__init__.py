"""Peak pressures from the contact's quadrature points: slices, fitted half-ellipses, tip-edge zones."""
