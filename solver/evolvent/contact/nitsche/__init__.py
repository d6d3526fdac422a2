"""Nitsche's contact operator: recovered flux, Coulomb's law, nodal forces."""
