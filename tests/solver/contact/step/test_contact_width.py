"""Width of a contact in cells: of known patches, in 2D and 3D; and the warning."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

from evolvent import (
    Body,
    CoarseContactWarning,
    Contact,
    Fixed,
    Freedom,
    Problem,
    Rigid,
    Step,
    StepSystem,
    condense_bodies,
    solve,
)
from evolvent.contact.step.contact_width import ContactWidth, measure_width, warn_if_coarse
from evolvent.contact.step.paired_surfaces import PairedSurfaces
from evolvent_meshes.shapes.blocks import box, cylinder_2d, graded_rectangle, rectangle
from tests.support.checkout import ROOT
from tests.support.contact_cases import rubber


def flat(d: int, supports: tuple[Fixed, ...] = ()) -> PairedSurfaces:
    """Pairs of two flat blocks of 8 mm: the first with cells of 0.5 mm, the second with cells of 0.8 mm."""
    if d == 2:
        upper, lower, down = rectangle(8.0, 1.0, 16, 1), rectangle(8.0, 1.0, 10, 1, origin=(0.0, -1.0)), "y"
    else:
        upper = box((8.0, 8.0, 1.0), (16, 16, 1), 1)
        lower, down = box((8.0, 8.0, 1.0), (10, 10, 1), 1, origin=(0.0, 0.0, -1.0)), "z"
    bodies = (
        Body(upper, supports=supports, rigid=Rigid("top", (Freedom(down, load=-1.0),))),
        Body(lower, supports=(Fixed("bottom"),)),
    )
    problem = Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=0.1),))
    return StepSystem(problem, condense_bodies(problem), Step()).paired[0]


@pytest.fixture(scope="module", params=[2, 3])
def paired(request: pytest.FixtureRequest) -> PairedSurfaces:
    return flat(request.param)


def test_width_of_a_strip(paired: PairedSurfaces) -> None:
    """A strip of 3 mm inside: 3 mm over the longer cells, 0.8 mm; to the quadrature points' distance."""
    x = paired.operator.points[:, 0]
    found = measure_width(paired, np.where((x > 2.0) & (x < 5.0), 7.0, 0.0))
    assert found.width == pytest.approx(3.0, abs=0.25)
    assert found.cell == pytest.approx(0.8, rel=1e-9)
    assert found.cells == pytest.approx(3.0 / 0.8, abs=0.3)


def test_width_is_that_of_the_narrowest_loaded_patch(paired: PairedSurfaces) -> None:
    """Two strips, of 3 and 1 mm: the width of the narrow one, unless it carries less than 5 % of the force."""
    x = paired.operator.points[:, 0]
    wide, narrow = (x > 1.0) & (x < 4.0), (x > 5.5) & (x < 6.5)
    assert measure_width(paired, 1.0 * (wide | narrow)).width == pytest.approx(1.0, abs=0.25)
    assert measure_width(paired, 1.0 * wide + 1e-3 * narrow).width == pytest.approx(3.0, abs=0.25)


def test_width_of_a_whole_surface(paired: PairedSurfaces) -> None:
    """A contact that presses on the whole surface is as wide as the surface."""
    assert measure_width(paired, np.ones(len(paired.operator.weights))).width == pytest.approx(8.0, abs=0.25)


def test_open_contact_has_no_width_and_no_warning(paired: PairedSurfaces) -> None:
    """An open contact is 0 mm and 0 cells wide, and not too coarse."""
    width = measure_width(paired, np.zeros(len(paired.operator.weights)))
    assert (width.width, width.cells) == (0.0, 0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_if_coarse("contact", width)


def test_number_of_cells_is_rounded_down_in_the_warning(paired: PairedSurfaces) -> None:
    """1.9996 cells are reported as 1.99."""
    with pytest.warns(CoarseContactWarning, match=r"found 1\.99, 2 mm"):
        warn_if_coarse("contact", ContactWidth(1.9996, 1.0))


def test_width_of_a_disc_and_of_a_ring() -> None:
    """In 3D a disc has the width of its diameter, a ring that of its band."""
    paired = flat(3)
    r = np.hypot(*(paired.operator.points[:, :2] - 4.0).T)
    assert measure_width(paired, 1.0 * (r < 2.0)).width == pytest.approx(4.0, abs=0.3)
    assert measure_width(paired, 1.0 * ((r > 2.0) & (r < 3.2))).width == pytest.approx(1.2, abs=0.3)


def test_longest_cell_at_the_edge_counts() -> None:
    """Rubber under a cylinder, cells of 0.3 mm over |x| <= 1.5 mm, which grow by 1.3 outside: the contact ends in the
    second of them, 0.5 mm long. That one counts; by those in the middle the contact was 12 cells wide."""
    contact = solve(rubber(0.3, 1.5)).contacts[0]
    assert contact.width.cell == pytest.approx(0.3 * 1.3**2, rel=0.1)
    assert contact.width.width == pytest.approx(4.0, abs=0.5)
    assert contact.cells_across == pytest.approx(8.0, abs=1.0)


def test_long_cells_along_a_strip_do_not_count() -> None:
    """A strip of 1.5 by 8 mm whose cells are 2 mm long along it and 0.25 mm across: 6 cells wide, up to its ends."""
    upper = box((8.0, 8.0, 1.0), (32, 4, 1), 1)
    lower = box((8.0, 8.0, 1.0), (32, 4, 1), 1, origin=(0.0, 0.0, -1.0))
    bodies = Body(upper, supports=(Fixed("top"),)), Body(lower, supports=(Fixed("bottom"),))
    problem = Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=0.1),))
    strip = StepSystem(problem, condense_bodies(problem), Step()).paired[0]
    x = strip.operator.points[:, 0]
    assert measure_width(strip, 1.0 * ((x > 3.0) & (x < 4.5))).cells == pytest.approx(6.0, abs=0.7)


@pytest.mark.parametrize(("supports", "width"), [((), 2.0), ((Fixed("left", "x"),), 4.0)])
def test_width_across_a_plane_of_symmetry_is_doubled(supports: tuple[Fixed, ...], width: float) -> None:
    """A contact up to a free edge ends there; up to a plane of symmetry it is half of the whole."""
    paired = flat(2, supports)
    found = measure_width(paired, 1.0 * (paired.operator.points[:, 0] < 2.0))
    assert found.width == pytest.approx(width, abs=0.25)


def roller(size: float) -> Problem:
    """Of 10 mm radius, pressed to a half-width of 0.33 mm (Hertz) with cells of `size` on both sides."""
    up = Body(cylinder_2d(10.0, size, 1.5), rigid=Rigid("top", (Freedom("y", load=-1e3),)))
    low = Body(graded_rectangle(20.0, 10.0, size, 1.5), supports=(Fixed("bottom"),))
    return Problem((up, low), (Contact((0, "arc"), (1, "top"), reach=0.2),))


def test_width_of_a_hertz_contact() -> None:
    """2a = 0.662 mm, within a tenth of a cell of 0.08 mm."""
    contact = solve(roller(0.08)).contacts[0]
    assert contact.cells_across == pytest.approx(0.662 / 0.08, abs=0.3)


def test_contact_of_less_than_two_cells_is_warned_of() -> None:
    """0.66 mm on cells of 0.5 mm: warned, with the contact, the cells and the size that would do; on finer ones not."""
    said = r"'arc' \(body 0, 'body'\) with 'top' .*2 cells wide, found 0\.99, .*at most 0\.\d+ mm on both"
    with pytest.warns(CoarseContactWarning, match=said):
        solve(roller(0.5))
    with warnings.catch_warnings():
        warnings.simplefilter("error", CoarseContactWarning)
        solve(roller(0.16))


@pytest.mark.parametrize(("cell", "warns"), [("0.1", False), ("0.7", True)])
def test_example_of_the_page_is_warned_of_on_coarse_cells(tmp_path: Path, cell: str, warns: bool) -> None:
    """docs/own_problem.md presses a hook to a contact of 1.1 mm with cells of 0.1 mm, and is not warned; with cells of
    0.7 mm it is."""
    page = (ROOT / "docs/own_problem.md").read_text()
    (program,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)[:1]
    program = program.replace("hook.msh", str(tmp_path / "hook.msh"))
    assert program.count("CELL = 2000.0, 0.1") == 1
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        exec(compile(program.replace("CELL = 2000.0, 0.1", f"CELL = 2000.0, {cell}"), "own_problem.md", "exec"), {})
    coarse = [w for w in caught if issubclass(w.category, CoarseContactWarning) and "'round'" in str(w.message)]
    assert bool(coarse) == warns
