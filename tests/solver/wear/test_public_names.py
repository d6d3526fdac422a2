"""The public names of wear: every one resolves, the page shows them, and none costs anything before it is used."""

from __future__ import annotations

import subprocess
import sys

import pytest

from evolvent import wear
from tests.support.checkout import ROOT

HEAVY = ("numpy", "scipy", "dolfinx", "petsc4py", "matplotlib")


@pytest.mark.parametrize("name", vars(wear)["__all__"])
def test_every_public_name_of_wear_resolves(name: str) -> None:
    """`from evolvent.wear import NAME` works for all names of `__all__`, and the object is documented."""
    assert getattr(wear, name).__doc__
    assert name in dir(wear)


@pytest.mark.parametrize("name", ["Archard", "Travel", "Cycle", "BlockSettings", "MeshMotion", "WearStudy"])
def test_names_of_a_study_are_on_the_page(name: str) -> None:
    """docs/wear.md has a row for each name that a study is made of."""
    assert f"| `{name}` |" in (ROOT / "docs/wear.md").read_text(encoding="utf-8")


def test_import_of_wear_loads_no_heavy_module() -> None:
    """A fresh interpreter has no heavy library after `import evolvent.wear`, and has NumPy after `Archard`."""
    program = (
        f"import sys, evolvent.wear\nprint([each for each in {HEAVY} if each in sys.modules])\n"
        "from evolvent.wear import Archard\nprint('numpy' in sys.modules)\n"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.splitlines() == ["[]", "True"]
