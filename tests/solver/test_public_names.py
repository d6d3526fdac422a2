"""The public names of the package: every one resolves, and none costs anything before it is used."""

from __future__ import annotations

import importlib
import subprocess
import sys

import pytest

import evolvent

HEAVY = ("numpy", "scipy", "dolfinx", "petsc4py", "gmsh", "pyvista", "matplotlib", "pydantic", "typer")


@pytest.mark.parametrize("name", evolvent.__all__)
def test_every_public_name_resolves_and_is_listed(name: str) -> None:
    """`from evolvent import NAME` works for all names of `__all__`, and `dir(evolvent)` has it."""
    assert getattr(importlib.import_module("evolvent"), name) is not None
    assert name in dir(evolvent)


def test_the_names_of_the_documented_import_are_public() -> None:
    """The names of the first line of every program for two bodies are those of the modules that define them."""
    from evolvent import Body, Contact, Fixed, Freedom, Material, Problem, Rigid, Step, read_msh, solve, sweep

    defined = (Body, Contact, Fixed, Freedom, Material, Problem, Rigid, Step, read_msh, solve, sweep)
    assert {each.__name__ for each in defined} <= set(evolvent.__all__)
    assert all(each.__module__.startswith(("evolvent.", "evolvent_meshes.")) for each in defined)


def test_import_loads_no_heavy_module_before_a_name_is_used() -> None:
    """A fresh interpreter has none of the heavy libraries after `import evolvent`, and has NumPy after `Body`."""
    program = (
        "import sys, evolvent\n"
        f"print(*(each for each in {HEAVY} if each in sys.modules), evolvent.__version__)\n"
        "from evolvent import Body\n"
        "print('numpy' in sys.modules)\n"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.splitlines() == [evolvent.__version__, "True"]


def test_an_unknown_name_is_refused_with_the_nearest_one() -> None:
    """`evolvent.Boddy` and a name like no other: AttributeError says what was wanted and what to do."""
    with pytest.raises(AttributeError, match=r"found 'Boddy'; did you mean Body\?"):
        evolvent.Boddy  # noqa: B018
    with pytest.raises(AttributeError, match=r"found 'qqqq'; dir\(evolvent\) lists"):
        evolvent.qqqq  # noqa: B018
