"""docs/meshes.md has every ready-made mesh, with its parameters and facet groups as they are."""

from __future__ import annotations

import inspect
import re
from types import ModuleType

import pytest

from evolvent_meshes.shapes import blocks, ellipse, rings, variants
from tests.support.checkout import ROOT

PAGE = (ROOT / "docs/meshes.md").read_text(encoding="utf-8")
ROWS = {row[0]: row for row in re.findall(r"^\| `(\w+)` \|(.*)\|(.*)\|(.*)\|$", PAGE, re.MULTILINE)}
MESHES = {
    "rectangle": blocks.rectangle(2.0, 1.0, 2, 1),
    "box": blocks.box((1.0, 1.0, 1.0), (1, 1, 1)),
    "graded_rectangle": blocks.graded_rectangle(4.0, 2.0, 0.5, 1.0),
    "graded_box": blocks.graded_box(4.0, 4.0, 1.0, 2.0),
    "cylinder_2d": blocks.cylinder_2d(10.0, 1.0, 2.0),
    "sphere_quarter": blocks.sphere_quarter(10.0, 4.0, 4.0, 1.0, 2.0),
    "ring_block": rings.ring_block(4.0, 4.0, 1.0, 1.0, 2.0),
    "ring_sphere": rings.ring_sphere(10.0, 4.0, 4.0, 1.0, 1.0, 2.0),
    "ellipse_block": ellipse.ellipse_block((2.0, 1.0), 4.0, 1.0, 2.0),
    "ellipse_punch": ellipse.ellipse_punch((2.0, 1.0), (0.01, 0.04), 4.0, 1.0, 2.0),
}


def quoted(text: str) -> set[str]:
    return set(re.findall(r"`(\w+)`", text))


@pytest.mark.parametrize("module", [blocks, rings, ellipse, variants], ids=lambda module: module.__name__)
def test_every_function_is_named(module: ModuleType) -> None:
    """All public functions of the modules stand on the page."""
    public = {name for name, f in inspect.getmembers(module, inspect.isfunction)
              if f.__module__ == module.__name__ and not name.startswith("_")}
    assert public
    assert public - quoted(PAGE) == set()


@pytest.mark.parametrize("name", MESHES)
def test_groups_and_parameters(name: str) -> None:
    """A row names exactly the facet groups that the mesh has, and all parameters but order and shape, which the page
    says of all."""
    _, _, groups, parameters = ROWS[name]
    assert quoted(groups) - {"contact"} == set(MESHES[name].facets)
    (function,) = (getattr(module, name) for module in (blocks, rings, ellipse) if hasattr(module, name)
                   and getattr(module, name).__module__ == module.__name__)
    named = quoted(parameters)
    for other in named & set(MESHES):
        named |= quoted(ROWS[other][3])
    assert set(inspect.signature(function).parameters) - {"order", "shape"} == named - set(MESHES)
