"""Corners of the matrix of settings that `make stress` goes through, and the tools it is made with."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from evidence.robustness.settings.ball import SETTINGS
from evidence.robustness.settings.distortion import distorted
from evidence.robustness.settings.independence import (
    CHANGE,
    MOST_ITERATIONS,
    cylinder_claims,
    gear_claims,
    iteration_claims,
    theta_claims,
)
from evidence.robustness.settings.matrix import Cylinder
from evidence.robustness.settings.sheets import Cell, attempt, draw, sheet_of, write_sheet
from evolvent.contact.newton.snes import NotConverged
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.shapes.blocks import box, rectangle
from tests.support.running.samples import sampled

CORNERS = {
    "γ at 200 times its limit": Cylinder(safety=200.0),
    "skew, γ far below its limit": Cylinder(safety=0.1, theta=-1.0),
    "μ = 1, a thousandth of the load": Cylinder(friction=1.0, load=1e-3),
    "μ = 1, ten times the load": Cylinder(friction=1.0, load=10.0),
    "1:8 across the contact": Cylinder(ratio=0.125),
    "8:1 across the contact": Cylinder(ratio=8.0, cells=32.0),
    "ν = 0.49": Cylinder(nu=0.49),
    "apart": Cylinder(gap=0.075),
    "overlapping": Cylinder(gap=-0.075),
}


@pytest.mark.parametrize("name", sampled(CORNERS, 2))
def test_corners_converge_to_hertz(name: str) -> None:
    """A steel cylinder on a steel block, a/R = 0.01: p0 of Hertz within 0.5 %."""
    assert CORNERS[name].cell().error < 5e-3


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(["μ = 1", "θ = −1"]))
def test_corners_of_the_ball_converge_to_hertz(name: str) -> None:
    """A steel ball on a steel block, second-order hexahedra of a/4: p0 of Hertz within 0.1 %."""
    assert SETTINGS[name].cell().error < 1e-3


@pytest.mark.evidence
@pytest.mark.slow
def test_theta_does_not_matter_to_gears() -> None:
    """He's pair as two whole bodies, θ = −1: the wheel's moment and the transmission error of the sweep, which has
    θ = 1 and one condensed sector a gear, within 0.5 %; p0 within 2 %, as it is fitted to the pressures of two elements
    at level quick (0.5 % at level fine is in docs/stress.md)."""
    for claim in theta_claims("quick", thetas=(-1.0,)):
        allowed = 2e-2 if claim.quantity.startswith("p0") else CHANGE
        assert claim.error <= allowed * abs(claim.wanted), str(claim)


def test_error_of_p0_sees_a_wrong_load() -> None:
    """The measure sees a load that is 2 % too large."""
    wrong = Cylinder(load=1.02)
    found = attempt(wrong.cell)
    assert found.error < 5e-3
    assert abs(Cylinder().peak / wrong.peak - 1.0) > 5e-3


def test_symmetric_method_below_its_limit_is_refused() -> None:
    """θ = 1 with γ half its limit has no positive definite stiffness: said, with what to do."""
    assert "Nitsche's γ" in attempt(Cylinder(safety=0.5).cell).refused


@pytest.mark.slow
def test_parameters_of_the_method_do_not_matter() -> None:
    """γ from 1.25 to 50 times the inverse-trace constant and θ = 1, −1: p0 of the cylinder is Hertz' within 0.5 %;
    torque and transmission error of the spur pair change by less than that, and so does its p0 at 6 elements across the
    contact; at 3 it is 0.6 %, the error of a fit to so few pressures. With friction at most 8 Newton iterations a
    position."""
    assert all(claim.holds for claim in cylinder_claims((1.25, 50.0), (1.0, -1.0)))
    for claim in gear_claims((1.25, 50.0)):
        allowed = 7e-3 if claim.quantity.startswith("p0") and "standard" in claim.quantity else CHANGE
        assert claim.error <= allowed * abs(claim.wanted), str(claim)
    assert all(claim.holds for claim in iteration_claims()), MOST_ITERATIONS


@pytest.mark.parametrize("mesh", [rectangle(2.0, 1.0, 5, 3), box((2.0, 2.0, 1.0), (3, 2, 2), 1, "tetrahedron")])
def test_distorted_mesh_has_the_wanted_quality(mesh: MeshData) -> None:
    """The wanted share of the scaled Jacobian, and the boundary where it was."""
    bad = distorted(mesh, 0.1, 0)
    assert scaled_jacobians(bad).min() == pytest.approx(0.1 * scaled_jacobians(mesh).min(), rel=1e-3)
    edge = np.unique(np.concatenate([facets.ravel() for facets in mesh.facets.values()]))
    np.testing.assert_array_equal(bad.points[edge], mesh.points[edge])


def test_sheet_keeps_refusals_and_passes_crashes_on(tmp_path: Path) -> None:
    """Refusals are kept with their message, drawn as such and written; a crash is a crash."""

    def solve(i: int, j: int) -> Cell:
        if i == j == 1:
            raise NotConverged("no equilibrium")
        return Cell(i + 1, 10.0 ** -(j + 1))

    sheet = sheet_of(("name", "title", "error"), ("row", ["a", "b"]), ("column", ["c", "d", "e"]), solve)
    assert sheet.refused == [("b", "d", "NotConverged: no equilibrium")]
    assert [text.get_text() for text in draw(sheet).axes[0].texts] == ["1", "1", "1", "2", "refused", "2"]
    write_sheet(sheet, tmp_path / "sheet.csv")
    assert "b,d,nan,nan,NotConverged: no equilibrium" in (tmp_path / "sheet.csv").read_text()
    with pytest.raises(ZeroDivisionError):
        sheet_of(("name", "title", "error"), ("row", ["a"]), ("column", ["b"]), lambda i, j: Cell(1 // 0))
