"""Condensed gears in line contact: their compliance against nodal forces, a spur pair against the resolved contact."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from evolvent.dynamics.excitation.loaded_mesh import in_line_contact, loaded_mesh
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.line.line_compliance import line_compliance
from evolvent.gears.line.line_gap import nominal_arcs
from evolvent.gears.line.line_gears import LineGears
from evolvent.gears.line.line_result import EdgeContact, LineResult, TooWide
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.problem.gear_problem import MeshSettings
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of, spur_scene

RELIEVED = tuple(
    f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("tip_relief_um=20", 'tip_relief_form="parabolic"')
)
TORQUES = [17e3, 85e3, 170e3]
ANGLES = 2.0 * np.pi / 50.0 * np.arange(8) / 8


@cache
def spur() -> LineGears:
    return LineGears.of(model_of(spur_scene(*RELIEVED, "mesh.level=line")))


@cache
def helical_model() -> GearModel:
    """Half as many rows and layers as at level line: what is compared is algebra."""
    problem = replace(gear_problem(helical_scene()), mesh=MeshSettings("line"))
    return prepare_model(problem, mesh=companion_mesh).model


def test_relieved_spur_pair_is_as_resolved() -> None:
    """Problem: He's pair with a parabolic relief of 20 µm, from 10 to 100 % of its torque, in plane strain. Reference:
    the contact resolved at level fine. Transmission error within 0.3 % of the deflection, peak to peak within 0.02 µm,
    tangent stiffness within 0.8 %."""
    fine = loaded_mesh(model_of(spur_scene(*RELIEVED, "mesh.level=fine")), TORQUES, ANGLES)
    line = loaded_mesh(model_of(spur_scene(*RELIEVED, "mesh.level=line")), TORQUES, ANGLES)
    assert line.errors == pytest.approx(fine.errors, rel=3e-3)
    assert np.ptp(line.errors, axis=0) == pytest.approx(np.ptp(fine.errors, axis=0), abs=2e-5)
    assert line.stiffness == pytest.approx(fine.stiffness, rel=8e-3)
    assert line.line is not None and line.line.on_edges.max() == 0.0


def test_torque_needs_no_other_meshes() -> None:
    """Exact: the meshes of a line contact do not depend on the torque, nor on modifications."""
    light = LineGears.of(model_of(spur_scene("mesh.level=line", "load.torque_Nm=20")))
    for one, other in zip(spur().gears, light.gears):
        assert one.arcs == pytest.approx(other.arcs, rel=1e-12)
        assert one.between_nodes.own == pytest.approx(other.between_nodes.own, rel=1e-9)


def test_compliance_is_the_work_of_nodal_forces() -> None:
    """Problem: a helical pair, loads on stations of two tooth pairs. Exact: forces at the nodes of the flanks, along
    their normals, applied to each condensed gear, and the work of the displacements there, 1e-7."""
    model = helical_model()
    gears = LineGears.of(model)
    position = gears.position(0.05)
    stations, shift = position.stations, np.clip(position.gap.shift, -0.1, 0.1)
    width = np.linspace(0.5, 1.0, len(shift))
    B = line_compliance(model.pair, gears.gears, stations, shift, width)
    picked = [int(np.flatnonzero(stations.tooth == tooth)[3]) for tooth in np.unique(stations.tooth)[:2]]
    load = np.zeros(len(stations.z))
    load[picked] = 100.0, 250.0
    work = sum(_work(model, gears, member, shift, width, stations, load) for member in Member)
    assert float(load @ B @ load) == pytest.approx(work, rel=1e-7)


def _work(model, gears, member, shift, width, stations, load) -> float:  # type: ignore[no-untyped-def]
    body, own = model.bodies[member], gears.gears[member]
    arc = nominal_arcs(model.pair, member, stations.roll_distance) + member.sign * shift
    rows, forces = [], []
    θ = np.arange(1, 25) * np.pi / 25
    for tooth in np.unique(stations.tooth[load > 0.0]):
        nodal = np.zeros(len(own.arcs) * len(own.heights))
        per_point = stations.hats @ np.where(stations.tooth == tooth, load, 0.0)
        for a, z, w, q in zip(arc, stations.point_z, width, per_point):
            if q > 0.0:
                shapes = own.shapes(a + w * np.cos(θ), np.full(24, z))
                nodal += q * np.asarray(shapes.T @ (2.0 / 25 * np.sin(θ) ** 2)).ravel()
        turned, places = _vectors(body, own, nodal, int(member.sign * tooth))
        rows.append(places)
        forces.append(turned)
    places, vectors = np.concatenate(rows), np.concatenate(forces)
    return float(np.sum(vectors * body.chain.apply(places, vectors, places)))


def _vectors(body, own, nodal: Floats, tooth: int):  # type: ignore[no-untyped-def]
    """Forces along the normals of the flank of a tooth, and their rows of the compliance."""
    radius = np.hypot(own.gear.base_radius, np.sqrt(2.0 * own.gear.base_radius * own.arcs))
    points, count = body.flank.points, len(own.heights)
    level = np.abs(points[:, 2][:, None] - own.heights).argmin(axis=1)
    row = np.abs(np.hypot(points[:, 0], points[:, 1])[:, None] - radius).argmin(axis=1)
    node = np.empty(len(points), dtype=int)
    node[row * count + level] = np.arange(len(points))
    normals = Flank(own.gear).helicoid_normal(np.sqrt(2.0 * own.gear.base_radius * own.arcs)[:, None], own.heights)
    angle = 2.0 * np.pi * tooth / own.gear.z
    R = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    vectors = (nodal[:, None] * normals.reshape(-1, 3)) @ R.T
    return vectors, np.column_stack([np.full(len(points), tooth), node])


def test_load_falls_towards_the_end_of_the_face() -> None:
    """Problem: a helical pair whose line reaches both ends of the face. Right: within half a contact width of an end
    the load per length is a tenth lower than without what `FaceEnds` adds, or more; the middle bears it; the torque is
    the same."""
    gears, half = LineGears.of(helical_model()), 0.5 * helical_model().pair.face_width
    position = gears.position(0.05)
    force = 60e3 / gears.base_radius
    found = LineResult.of(position, force)
    without = LineResult.of(replace(position, system=replace(position.system, ends=None)), force)
    b = position.half_width(found.equilibrium.load).max()
    tooth = max(found.teeth, key=found.force)
    for side in (-half, half - b):
        ends = np.array([side, side + b])
        assert np.diff(found.force_below(tooth, ends)) < 0.9 * np.diff(without.force_below(tooth, ends))
    middle = np.array([-0.2 * half, 0.2 * half])
    assert np.diff(found.force_below(tooth, middle)) > np.diff(without.force_below(tooth, middle))
    assert found.forces == pytest.approx(without.forces, rel=1e-9)


def test_compliance_is_symmetric_and_positive() -> None:
    """Exact: B is symmetric, and positive definite on loads that the mesh tells apart."""
    B = LineGears.of(helical_model()).position(0.1).system.B
    assert np.abs(B - B.T).max() == 0.0
    assert np.linalg.eigvalsh(B).min() > -1e-12 * np.abs(B).max()


def test_edges_that_bear_are_said() -> None:
    """Problem: He's pair without relief: the edge of a tip comes into contact early. An error where the only torque has
    such positions; under a list, the torques from there on are left out."""
    mesh = loaded_mesh(model_of(spur_scene("mesh.level=line")), TORQUES, ANGLES)
    with pytest.raises(EdgeContact, match=r"of the load, at \d of 8 positions"):
        in_line_contact(mesh, TORQUES[-1])
    relieved = ("pinion.tip_relief_um=4", "wheel.tip_relief_um=4")
    partly = loaded_mesh(model_of(spur_scene(*relieved, "mesh.level=line")), TORQUES, ANGLES)
    kept, sentence = in_line_contact(partly, 17e3)
    assert kept.torques.tolist() == TORQUES[: len(kept.torques)] and 0 < len(kept.torques) < 3
    assert kept.errors.shape == (8, len(kept.torques)) and "have no figures" in sentence


def test_too_wide_a_contact_is_refused() -> None:
    """Problem: so much load that the contact is wider than the mesh carries it."""
    with pytest.raises(TooWide, match="lower the torque"):
        LineResult.of(spur().position(0.06), 3e3)


def test_short_steep_reliefs_do_not_jump() -> None:
    """Problem: linear relief of 40 µm over the last 0.75 mm of He's pair, at thirty positions a hundredth of a pitch's
    third apart, about the entry of a tooth. Right: the transmission error is continuous; parabolas fitted over a kink
    lose it, by up to 2.3 µm at single positions."""
    steep = [f"{gear}.{key}" for gear in ("pinion", "wheel")
             for key in ("tip_relief_um=40", "tip_relief_start_diameter_mm=154.5")]
    gears = LineGears.of(model_of(spur_scene("mesh.level=line", *steep)))
    step = 2.0 * np.pi / 50.0 / 300.0
    errors = [
        1e3 * LineResult.of(gears.position(number * step), 170e3 / gears.base_radius / gears.width_factor)
        .transmission_error for number in range(75, 105)
    ]
    assert np.abs(np.diff(errors)).max() < 0.3
