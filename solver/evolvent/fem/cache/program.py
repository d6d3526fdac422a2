"""Identity of the program and of the libraries by which values are computed."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import evolvent_meshes
from evolvent_meshes.digests import digest

LIBRARIES = ("fenics-dolfinx", "fenics-basix", "fenics-ffcx", "petsc4py", "numpy", "scipy", "numba", "gmsh")


@cache
def program_identity() -> str:
    """SHA-256 of the source files of both packages and of the versions of the libraries that they compute with."""
    sources: dict[str, str] = {}
    for root in (Path(__file__).parents[2], Path(str(evolvent_meshes.__file__)).parent):
        sources |= {f"{root.name}/{path.relative_to(root)}": path.read_text("utf-8") for path in root.rglob("*.py")}
    return digest((sources, {name: _version(name) for name in LIBRARIES}))


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "none"
