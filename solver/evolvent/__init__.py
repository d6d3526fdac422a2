"""Evolvent's solver: frictional contact of elastic bodies, and of gear pairs, with dolfinx and PETSc."""

from importlib import metadata

try:
    __version__ = metadata.version("evolvent")
except metadata.PackageNotFoundError:  # a checkout that was not installed
    __version__ = "unknown"
