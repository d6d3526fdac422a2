"""The fields for ParaView, read back with pyvista, and the smooth fields on exact flanks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista
from synthetic_run import synthetic_run

from meshes.flank import contact_normal
from solver.fields import write_fields
from solver.flank_field import flank_field, flank_patch
from solver.gear_surfaces import Polygons, joined, sector_surface, space_vectors
from solver.run_data import RunData


@pytest.fixture(scope="module")
def run() -> RunData:
    return synthetic_run("contact.friction=[0.0, 0.1]")


def test_series_opens_with_its_times_and_arrays(run: RunData, tmp_path: Path) -> None:
    """Exact: one time a position, the pinion rotation in degrees; the largest nodal pressure as computed; one array per
    friction coefficient; pressures on both gears."""
    reader = pyvista.get_reader(str(write_fields(run, tmp_path)))
    np.testing.assert_allclose(reader.time_values, np.degrees(run.angles), atol=1e-6)
    for k, time in enumerate(reader.time_values):
        reader.set_active_time_value(time)
        flanks, gears = reader.read()[:2]
        for solved in run.positions[k]:
            pressure = flanks[f"pressure_MPa (mu={solved.result.friction:g})"]
            assert pressure[flanks["gear"] == 0].max() == pytest.approx(solved.result.pressure.max(), rel=1e-6)
            assert pressure[flanks["gear"] == 1].max() == pytest.approx(solved.result.pressure.max(), rel=0.15)
        assert gears.n_cells > 1000
    assert not list(tmp_path.glob("writing_*"))


def test_nodes_stand_where_the_solver_had_them(run: RunData, tmp_path: Path) -> None:
    """Exact: the placed pinion flank nodes under pressure are the solver's points in space (single precision)."""
    reader = pyvista.get_reader(str(write_fields(run, tmp_path)))
    flanks, result = reader.read()[0], run.positions[0][0].result
    loaded = (flanks["pressure_MPa (mu=0)"] > 0.0) & (flanks["gear"] == 0)
    own = result.points[result.pressure > 0.0]
    assert loaded.sum() == len(own)
    np.testing.assert_allclose(np.sort(flanks.points[loaded], axis=0), np.sort(own, axis=0), atol=1e-5)


def test_traction_balances_the_torque(run: RunData) -> None:
    """Problem: frictionless tractions on the pinion in space. Exact: all point along the one normal of the plane of
    action (to the small free rotation), and their moment about the pinion's axis is −T_1 = −250 N·m (nodal quadrature
    on the quick mesh: 2 %)."""
    result = run.positions[0][0].result
    vectors = space_vectors(run, result, result.traction)
    loaded = result.pressure > 0.0
    unit = vectors[loaded] / np.linalg.norm(vectors[loaded], axis=1, keepdims=True)
    # away from the nominal line the flank's normal turns with the rolling angle: b/ρ, at most 0.2 near the root
    assert np.all(unit @ contact_normal(run.pair) > 0.97)
    on_pinion = -vectors * result.weights[:, None]
    moment = np.cross(result.points, on_pinion)[:, 2].sum()
    assert moment == pytest.approx(-250e3, rel=0.02)


def test_field_reproduces_nodes_and_ridge(run: RunData) -> None:
    """Problem: a Hertz ridge, four node intervals wide, across rows of nodes. Exact: the field's maximum over each
    column is the ridge's height: within what a piecewise linear profile loses (an eighth of an interval off the top: 8 %), on
    the pinion and mirrored on the wheel alike; 0 away from the line."""
    result = run.positions[0][0].result
    field = flank_field(run, result, 0, result.pressure)
    cut = run.positions[0][0].cut
    here = (cut.tooth == 0) & np.isfinite(cut.peak)
    for gear in (0, 1):
        patch = flank_patch(run, gear, (900, 60))
        values = patch.values(run, result, 0, field)
        inner = (patch.z > cut.z[here].min() + 1.0) & (patch.z < cut.z[here].max() - 1.0)
        order = np.argsort(cut.z[here])
        ridge = np.interp(patch.z, cut.z[here][order], cut.peak[here][order])
        np.testing.assert_allclose(values.max(axis=0)[inner], ridge[inner], rtol=0.12)
        assert np.mean(values > 0.0) < 0.12


def test_plane_run_is_drawn_over_its_width(tmp_path: Path) -> None:
    """Problem: a 2D run. Exact: flanks from −b/2 to b/2, the sector closed all round: its surface has no free edge but
    where it joins its neighbours at the two cuts."""
    plane = synthetic_run(file="demos/he2022.toml")
    reader = pyvista.get_reader(str(write_fields(plane, tmp_path)))
    assert reader.read()[0].bounds[4:6] == pytest.approx((-10.0, 10.0))
    sector = sector_surface(plane.shapes[0], 20.0, with_flank=True)
    edges: dict[tuple[int, int], int] = {}
    for face in sector.faces:
        for a, b in zip(face.ravel(), np.roll(face, -1, axis=1).ravel()):
            edges[min(a, b), max(a, b)] = edges.get((min(a, b), max(a, b)), 0) + 1
    free = np.array([edge for edge, count in edges.items() if count == 1])
    angle = np.arctan2(*sector.points[free.ravel()][:, [1, 0]].T)
    np.testing.assert_allclose(np.abs(angle), np.pi / 50, atol=1e-6)


def test_joined_keeps_faces_of_every_size() -> None:
    """Two triangles and a square side by side keep their corners after joining."""
    triangle = Polygons(np.eye(3), (np.array([[0, 1, 2]]),))
    square = Polygons(np.zeros((4, 3)), (np.array([[0, 1, 2, 3]]),))
    both = joined([triangle, square, triangle])
    assert sorted(face.tolist() for face in both.faces) == [[[0, 1, 2], [7, 8, 9]], [[3, 4, 5, 6]]]
