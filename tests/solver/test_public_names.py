"""The public names of the package: every one resolves, and none costs anything before it is used."""

from __future__ import annotations

import importlib
import subprocess
import sys
from types import ModuleType

import pytest

import evolvent
from tests.support.checkout import ROOT

HEAVY = ("numpy", "scipy", "dolfinx", "petsc4py", "gmsh", "pyvista", "matplotlib", "pydantic", "typer")


SOURCES = ROOT / "solver"
PACKAGES = sorted(
    ".".join(path.relative_to(SOURCES).parent.parts)
    for path in SOURCES.rglob("__init__.py") if "lazy_names(" in path.read_text(encoding="utf-8")
)
"""Those with public names of their own."""


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_resolves_and_is_listed(package: str) -> None:
    """`from PACKAGE import NAME` works for all names of `__all__`, and `dir(PACKAGE)` has them alone."""
    door = importlib.import_module(package)
    assert [name for name in door.__all__ if getattr(door, name, None) is None] == []
    assert dir(door) == sorted(door.__all__)


def test_packages_are_public_names() -> None:
    """After `import evolvent` alone `evolvent.wear` and `evolvent.gears` can be used; both doors are tested here."""
    assert evolvent.wear.Archard.__module__ == "evolvent.wear.archard"
    assert evolvent.gears.__name__ == "evolvent.gears"
    assert {"evolvent", "evolvent.wear"} <= set(PACKAGES)
    assert evolvent.dynamics.vibration.__module__ == "evolvent.dynamics.solution.vibration"
    assert evolvent.strength.root_stress.__module__ == "evolvent.strength.solution.root_stress"
    assert evolvent.fatigue.dang_van.__module__ == "evolvent.strength.fatigue.criteria"


def test_the_names_of_the_documented_import_are_public() -> None:
    """The names of the first line of every program for two bodies are those of the modules that define them."""
    from evolvent import Body, Contact, Fixed, Freedom, Material, Problem, Rigid, Step, read_msh, solve, sweep

    defined = (Body, Contact, Fixed, Freedom, Material, Problem, Rigid, Step, read_msh, solve, sweep)
    assert {each.__name__ for each in defined} <= set(dir(evolvent))
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


@pytest.mark.parametrize("package", [each for each in PACKAGES if each != "evolvent"])
def test_import_of_a_package_loads_no_heavy_module(package: str) -> None:
    """A fresh interpreter has none of the heavy libraries after the import of a public package alone."""
    program = f"import sys, {package}\nprint([each for each in {HEAVY} if each in sys.modules])\n"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.splitlines() == ["[]"]


@pytest.mark.parametrize("package", PACKAGES)
def test_no_public_name_is_that_of_a_room(package: str) -> None:
    """A function with the name of a folder or file of its package would be replaced by it once that is imported. Right:
    a public name of a folder's is that folder itself."""
    door = importlib.import_module(package)
    folder = SOURCES.joinpath(*package.split("."))
    inside = {path.stem for path in folder.iterdir() if path.suffix == ".py" or path.is_dir()}
    assert [name for name in inside & set(door.__all__) if not isinstance(getattr(door, name), ModuleType)] == []


def test_an_unknown_name_is_refused_with_the_nearest_one() -> None:
    """`evolvent.Boddy` and a name like no other: AttributeError says what was wanted and what to do."""
    with pytest.raises(AttributeError, match=r"found 'Boddy'; did you mean Body\?"):
        getattr(evolvent, "Boddy")  # noqa: B009
    with pytest.raises(AttributeError, match=r"found 'qqqq'; dir\(evolvent\) lists"):
        getattr(evolvent, "qqqq")  # noqa: B009
