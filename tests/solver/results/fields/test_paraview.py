"""The fields for ParaView, read back with pyvista, and the smooth fields on exact flanks."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista

from evolvent.gears.pressure.contact_slices import on_tip_edge
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.fields.flank_field import flank_field, flank_patch, line_distance
from evolvent.results.fields.paraview import flank_fields, write_fields
from evolvent.results.fields.polygons import Polygons, joined, sector_surface, sliding, space_vectors
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent_meshes.gears.flank import contact_normal
from evolvent_meshes.gears.member import Member
from tests.support.synthetic_run import synthetic_run


@pytest.fixture(scope="module")
def run() -> RunData:
    return synthetic_run("contact.friction=[0.0, 0.1]")


def test_series_opens_with_its_times_and_arrays(run: RunData, tmp_path: Path) -> None:
    """Exact: one time a position, the pinion rotation in degrees; the largest nodal pressure as computed; one array per
    friction coefficient; pressures on both gears, on the wheel, whose layers are others, to 15 %."""
    reader = pyvista.get_reader(str(write_fields(run, RunFolder(tmp_path))))
    np.testing.assert_allclose(reader.time_values, np.degrees(run.angles), atol=1e-6)
    for k, time in enumerate(reader.time_values):
        reader.set_active_time_value(time)
        flanks, gears = reader.read()[:2]
        for solved in run.positions[k]:
            name = f"pressure_MPa (mu={solved.result.friction:g})"
            pressure = np.fmax(flanks[name], flanks["edge_" + name])  # of NaN and a number the number
            assert pressure[flanks["gear"] == 0].max() == pytest.approx(solved.result.pressure.max(), rel=1e-6)
            assert pressure[flanks["gear"] == 1].max() == pytest.approx(solved.result.contact.pressure.max(), rel=0.15)
        assert gears.n_cells > 1000
    assert not list(tmp_path.rglob("*.evolvent-part*"))


def test_tip_edges_do_not_swamp_the_scale(run: RunData) -> None:
    """Problem: 20,000 MPa at all contact points and nodes in layers that bear on a tip edge, as a corner leaves. Exact:
    pressure and traction that ParaView scales its colours by have none of them, on either gear, and NaN where they are;
    they stand in edge_pressure_MPa. Layers that bear on no edge keep theirs, and NaN is nowhere else."""

    def singular(solved: SolvedPosition) -> SolvedPosition:
        result, bears = solved.result, np.zeros(len(solved.result.node), dtype=bool)
        for tooth in np.unique(result.tooth):
            mine = result.tooth == tooth
            bears[mine] = on_tip_edge(solved.cut, int(tooth), run.flank.z[result.node[mine]])
        traction = result.traction.copy()
        traction[bears & (result.pressure > 0.0), 0] = 2e4
        return replace(solved, result=replace(result, traction=traction))

    solved = tuple(singular(each) for each in run.positions[2])
    _, arrays = flank_fields(run, solved)
    for each in solved:
        at = f"pressure_MPa (mu={each.result.friction:g})"
        pressure, edge = arrays[at], arrays[f"edge_{at}"]
        for gear in (0, 1):
            own = arrays["gear"] == gear
            assert 1000.0 < np.nanmax(pressure[own]) < 3500.0
            assert edge[own].max() > 1.5e4
        np.testing.assert_array_equal(np.isnan(pressure), edge > 0.0)
        traction = arrays[f"traction_MPa (mu={each.result.friction:g})"]
        np.testing.assert_array_equal(np.isnan(traction).all(axis=1), edge > 0.0)
        assert np.nanmax(np.abs(traction)) < 3500.0
        assert np.isfinite(pressure[arrays["gear"] == 0]).mean() > 0.98


def test_pressures_over_relief_starts_stand_apart() -> None:
    """Problem: a spur pair with linear tip reliefs, whose contact covers the start of one at some positions and of none
    at others. Exact: teeth over a start have their pressures in kink_pressure_MPa alone, all others in pressure_MPa."""
    relief = ("pinion.tip_relief_um=20", "wheel.tip_relief_um=20")
    run = synthetic_run("sweep.positions=8", *relief, file="demos/he2022.toml")
    covers = 0
    for (solved,) in run.positions:
        _, arrays = flank_fields(run, (solved,))
        pressure, kink = arrays["pressure_MPa (mu=0)"], arrays["kink_pressure_MPa (mu=0)"]
        for tooth in solved.teeth:
            own, (over,) = arrays["tooth"] == tooth.tooth, solved.cut.kink[solved.cut.tooth == tooth.tooth]
            if tooth.edge_pressure > 0.0:
                continue
            assert (kink[own].max() > 300.0) == over and (np.nanmax(pressure[own]) > 300.0) == (not over)
            assert (tooth.kink_pressure > 0.0) == over
            covers += over
    assert 0 < covers < 8


def test_nodes_stand_where_the_solver_had_them(run: RunData, tmp_path: Path) -> None:
    """Exact: a pinion flank node under pressure lies within the contact's half-width (0.2 mm at most) of the plane of
    action, in which all contact lines stand in space: distance (x − r_b1 n)·n with n along the line of action."""
    reader = pyvista.get_reader(str(write_fields(run, RunFolder(tmp_path))))
    flanks = reader.read()[0]
    loaded = (flanks["pressure_MPa (mu=0)"] > 0.0) & (flanks["gear"] == 0)  # NaN is not
    assert loaded.sum() > 100
    pair = run.pair
    angle, base = pair.working_pressure_angle, pair.pinion.base_radius
    off_plane = flanks.points[loaded] @ [np.cos(angle), -np.sin(angle), 0.0] - base
    assert np.abs(off_plane).max() < 0.25
    turned = flanks.points[loaded] @ [np.cos(angle), np.sin(angle), 0.0] - base
    assert np.abs(turned).max() > 1.0


def test_traction_balances_the_torque(run: RunData) -> None:
    """Problem: frictionless tractions on the pinion in space. Exact: all point along the one normal of the plane of
    action but for the rolling angle b/ρ, and their moment about the pinion's axis is −T_1 = −250 N·m (nodal quadrature
    on the quick mesh: 4 %)."""
    result = run.positions[0][0].result
    vectors = space_vectors(run, result, result.traction)
    loaded = result.pressure > 0.0
    unit = vectors[loaded] / np.linalg.norm(vectors[loaded], axis=1, keepdims=True)
    assert np.all(unit @ contact_normal(run.pair) > 0.97)
    points = np.concatenate([
        run.flank.points[result.node[result.tooth == i]] @ result.stand.rotation(Member.PINION, 3, i).T
        for i in np.unique(result.tooth)
    ])
    moment = np.cross(points, -vectors * result.weights[:, None])[:, 2].sum()
    assert moment == pytest.approx(-250e3, rel=0.04)


def test_sliding_vanishes_at_the_pitch_line(run: RunData) -> None:
    """Exact: at the contact line the sliding velocity is (1 + 1/u) ξ along the profile, 0 at the pitch point, and after
    it the pinion's flank moves inwards over the wheel's; nodes up to 0.05 mm beside the line differ by as much."""
    result = run.positions[0][0].result
    v = sliding(run, result, 0)
    s = line_distance(run.pair, result, 0, Member.PINION, run.flank.roll_length, run.flank.z)
    ξ = run.pair.roll_distance(result.stand.angle, 0, run.flank.z)
    on_line = np.abs(s) < 0.05
    outwards = np.einsum("ja,ja->j", v, run.flank.points @ result.stand.rotation(Member.PINION, 3, 0).T)
    assert on_line.sum() > 20
    exact = (1.0 + 1.0 / run.pair.ratio) * ξ[on_line]
    np.testing.assert_allclose(np.linalg.norm(v[on_line], axis=1), np.abs(exact), atol=0.08)
    far = np.abs(exact) > 0.2
    assert np.all(np.sign(outwards[on_line][far]) == -np.sign(exact[far]))


def test_field_reproduces_nodes_and_ridge(run: RunData) -> None:
    """Problem: a Hertz ridge that crosses the rows of nodes at an angle, four node intervals wide. Exact: the field's
    maximum over each column is the ridge's height p0(ξ), on the pinion and mirrored on the wheel, within what a curve
    through five points of an ellipse loses (an eighth of the width off its top: 7 %); the field is 0 away from the
    line: the ridge covers less than an eighth of the flank."""
    solved = run.positions[0][0]
    field, cut = flank_field(run, solved.result, 0), solved.cut
    here = (cut.tooth == 0) & np.isfinite(cut.hertz)
    order = np.argsort(cut.z[here])
    for gear in Member:
        patch = flank_patch(run, gear, (2400, 60))
        values = patch.values(run, solved.result, 0, field)
        inner = (patch.z > cut.z[here].min() + 1.0) & (patch.z < cut.z[here].max() - 1.0)
        ridge = np.interp(patch.z, cut.z[here][order], cut.hertz[here][order])
        np.testing.assert_allclose(values.max(axis=0)[inner], ridge[inner], rtol=0.08)
        assert np.mean(values > 0.0) < 0.12


def test_plane_run_is_drawn_over_its_width(tmp_path: Path) -> None:
    """Problem: a 2D run. Exact: flanks from −b/2 to b/2, the sector closed all round: its surface has no free edge but
    where it joins its neighbours at the two cuts."""
    plane = synthetic_run(file="demos/he2022.toml")
    reader = pyvista.get_reader(str(write_fields(plane, RunFolder(tmp_path))))
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
