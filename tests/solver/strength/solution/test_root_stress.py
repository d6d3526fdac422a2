"""Root stress from Python: the figures of `evolvent strength`, the standard, refusals, files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import load_scene
from evolvent.strength import RootStress, iso_6336_3, root_formulas, root_stress
from evolvent_meshes.errors import InputError
from tests.support.checkout import ROOT
from tests.support.gear_cases import QUIET
from tests.support.recorded_tables import assert_same_rows, columns_of, tables_of

SCENE = ROOT / "demos/he2022.toml"
SETTINGS = (*QUIET, "mesh.level=quick", "mesh.order=1", "sweep.positions=4", "contact.friction=[0.0,0.1]")
PROBLEM = gear_problem(load_scene(SCENE, SETTINGS))


@pytest.fixture(scope="module")
def roots() -> RootStress:
    """Four uniform positions and those around the largest stresses."""
    return root_stress(PROBLEM, [0.0, 0.1], positions=4)


def test_figures_are_those_of_the_command(roots: RootStress, tmp_path: Path) -> None:
    """Problem: He's pair, first-order cells, four positions, two friction coefficients, once by `evolvent strength` and
    once by functions. Exact: all rows of strength.csv and root_stress.csv, to 1e-9 (mean and amplitude of a stress, and
    the place where it is largest, too)."""
    known = tables_of("strength", SCENE, tmp_path / "out", *SETTINGS)
    assert_same_rows(roots.stresses((2006, 2019)), known["strength.csv"])
    assert_same_rows(roots.curves, known["root_stress.csv"])


def test_formulas_are_rows_of_the_command(roots: RootStress) -> None:
    """The rows without a friction coefficient; the standard alone has the same stress, and the product of its factors
    and F_t/(b m_n) is that stress, to 1e-12."""
    formulas = root_formulas(PROBLEM.pair, PROBLEM.torque)
    assert_same_rows(formulas, [row for row in roots.stresses((2006, 2019)) if np.isnan(row.friction)], 1e-15)
    for own, gear in zip(iso_6336_3(PROBLEM.pair, PROBLEM.torque, 2019), ("pinion", "wheel")):
        (row,) = [row for row in formulas if (row.gear, row.method) == (gear, "ISO 6336-3:2019")]
        factors = own.form_factor * own.stress_correction_factor * own.helix_angle_factor * own.rim_thickness_factor
        pinion = PROBLEM.pair.pinion
        face = 2.0 * PROBLEM.torque / pinion.reference_diameter / PROBLEM.pair.face_width / pinion.normal_module
        assert own.stress == row.stress_MPa == pytest.approx(face * factors, rel=1e-12)


def test_root_stress_is_saved_and_drawn(roots: RootStress, tmp_path: Path) -> None:
    """The saved column is the curve; the picture is a PNG image."""
    table = columns_of(roots.save(tmp_path / "roots.csv"))
    np.testing.assert_allclose(table["tension_MPa"], [row.tension_MPa for row in roots.curves], rtol=1e-8, atol=1e-8)
    with Image.open(roots.plot(tmp_path / "roots.png")) as image:
        assert image.format == "PNG" and image.width > 1000


@pytest.mark.parametrize(("wrong", "words"), [
    ({"problem": PROBLEM.pair}, "problem: wanted"),
    ({"frictions": [0.1, 0.1]}, "frictions: wanted one coefficient or several different ones"),
    ({"positions": 1}, "positions: wanted a whole number from 2 on"),
    ({"refinement": 0}, "refinement: wanted a whole number from 1 to 4"),
])
def test_roots_that_cannot_be_are_refused(wrong: dict[str, Any], words: str) -> None:
    """InputError names argument, value and remedy."""
    with pytest.raises(InputError, match=words):
        root_stress(**{"problem": PROBLEM, **wrong})


@pytest.mark.parametrize(("wrong", "words"), [
    ({"pair": PROBLEM}, "pair: wanted"), ({"pinion_torque": 0.0}, "pinion_torque: wanted a number above 0, in N·mm"),
    ({"edition": 2013}, "edition: wanted 2006 or 2019, found 2013"),
])
def test_a_standard_that_cannot_be_is_refused(wrong: dict[str, Any], words: str) -> None:
    """InputError names argument, value and remedy."""
    with pytest.raises(InputError, match=words):
        iso_6336_3(**{"pair": PROBLEM.pair, "pinion_torque": 170e3, "edition": 2019, **wrong})


@pytest.mark.parametrize(("wrong", "words"), [
    ({"editions": (2020,)}, "edition: wanted 2006 or 2019, found 2020"),
    ({"editions": ("2019",)}, "edition: wanted 2006 or 2019, found '2019'"),
    ({"editions": 2019}, r"editions: wanted a sequence of numbers, found 2019; write editions=\(2019,\)"),
    ({"editions": None}, "editions: wanted a sequence of numbers, found None"),
    ({"editions": (2006,), "tolerance_class": 0}, "tolerance_class: wanted 1 or 2 or"),
])
def test_an_edition_that_there_is_not_has_no_row(roots: RootStress, wrong: dict[str, Any], words: str) -> None:
    """No row is labelled with an edition of the standard that there is not."""
    with pytest.raises(InputError, match=words):
        roots.stresses(**wrong)
    with pytest.raises(InputError, match=words):
        root_formulas(PROBLEM.pair, PROBLEM.torque, **wrong)
