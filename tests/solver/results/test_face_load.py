"""The face load factor: exact for made-up loads over the face, and of pairs that were solved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from evidence.benchmarks.accuracy.error_bars import SCENES, solved
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.pressure.contact_slices import Slices, layer_edges
from evolvent.results.error_bars.estimation import errors_between
from evolvent.results.error_bars.position_spacing import spacing_errors
from evolvent.results.face_load import FaceLoad, face_load
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.scene.scene import Scene, load_scene
from evolvent_meshes.arrays import Floats
from tests.support.gear_cases import QUIET
from tests.support.synthetic_run import resolved_slices, synthetic_run

COARSE = ("mesh.elements_per_contact_width=0.6", "mesh.order=1", "sweep.positions=3", "contact.friction=0.0", *QUIET)

Load = Callable[[Floats, int], Floats]
"""Normal force per face width (n,) [N/mm] at heights (n,) [mm], at a position."""


def loaded(run: RunData, load: Load) -> RunData:
    """The run with another load over the common face, more of it on each tooth pair than on the one before."""
    edges, half = layer_edges(run.flank.z), 0.5 * run.pair.face_width
    cos_b = np.cos(run.pair.pinion.base_helix_angle)
    inside = np.clip(edges, -half, half)
    middle, extent = 0.5 * (inside[:-1] + inside[1:]), np.diff(inside)

    def changed(solved: SolvedPosition, position: int) -> SolvedPosition:
        borne = np.flatnonzero(extent > 0.0)
        force = (load(middle, position) * extent)[borne]
        width, z, one = np.diff(edges)[borne], (0.5 * (edges[1:] + edges[:-1]))[borne], np.ones(len(borne))
        parts = []
        for number, tooth in enumerate(solved.teeth):
            share = (number + 1.0) / sum(range(1, len(solved.teeth) + 1))
            columns = z, 0.0 * z, width, share * force * cos_b / width, *[one] * 5, one < 0.0
            parts.append(resolved_slices(np.full(len(borne), tooth.tooth), *columns))
        return replace(solved, cut=Slices.joined(parts))

    positions = tuple((changed(each[0], k),) for k, each in enumerate(run.positions))
    return replace(run, positions=positions)


def helical(*settings: str) -> RunData:
    """Yang's pair at made-up positions."""
    return synthetic_run("contact.friction=0.1", *settings)


def test_linear_load_has_the_factor_of_its_end_layer() -> None:
    """Problem: 100 (1 + 0.4·2z/b) N/mm on Yang's pair, at each position with another height of all of it and another
    parabola, which cancel over the pitch. Exact: the mean load is linear, K = 1 + 0.4·2z/b in the middle of the last
    layer, 0.4 at the end of the face; the load of each layer is that in its middle."""
    run = helical()
    b, n = run.pair.face_width, len(run.positions)

    def load(z: Floats, position: int) -> Floats:
        sway = np.cos(2.0 * np.pi * position / n)
        return 100.0 * (1.0 + 0.8 * z / b + sway * (0.3 + (z / b) ** 2))

    found = face_load(loaded(run, load), 0)
    assert found.factor() == pytest.approx(1.0 + 0.8 * found.z[-1] / b, rel=1e-9)
    np.testing.assert_allclose(found.relative(), 1.0 + 0.8 * found.z / b, rtol=1e-9)
    assert 0.37 < found.factor() - 1.0 < 0.4
    assert np.diff(found.ends, axis=1).sum() == pytest.approx(b, rel=1e-12)


def test_load_that_is_even_at_no_position_may_be_even_over_the_cycle() -> None:
    """Problem: all of the load on one half of the face at every other position, on the other half at the rest. Exact:
    K = 1, where the mean of the positions' own factors would be 2."""
    run = helical()
    found = face_load(loaded(run, lambda z, position: np.where((z > 0.0) == (position % 2 == 0), 100.0, 0.0)), 0)
    assert found.factor() == pytest.approx(1.0, rel=1e-9)
    assert found.factor(np.array([0, 2, 4])) == pytest.approx(2.0, rel=1e-9)


@pytest.mark.parametrize(("pinion", "layers"), [(22.0, 6), (21.0, 8), (27.0, 6), (20.5, 8)])
def test_layer_on_the_common_face_in_part_counts_in_part(pinion: float, layers: int) -> None:
    """Problem: a pinion wider than the wheel of 20 mm, 50 N/mm on the common face. Exact: K = 1 however much of the end
    layers lies on it, 20 mm in layers; a linear load is as steep as it is."""
    wide = ("contact.friction=0.1", f"pinion.face_width_mm={pinion}")
    run = synthetic_run(*wide, file="demos/he2022.toml")
    found = face_load(loaded(run, lambda z, _: np.full_like(z, 50.0)), 0)
    assert len(found.z) == layers and np.diff(found.ends, axis=1).sum() == pytest.approx(20.0)
    np.testing.assert_allclose(found.relative(), 1.0, rtol=1e-9)
    found = face_load(loaded(run, lambda z, _: 50.0 + 2.0 * z), 0)
    np.testing.assert_allclose(found.relative(), 1.0 + 0.04 * found.z, rtol=1e-9)


def test_short_part_of_a_layer_joins_the_next_one() -> None:
    """Problem: He's pair with a pinion of 22.5 mm, whose end layers have next to nothing of the wheel's 20 mm, and ten
    times the load there. Exact: the mean over these parts and the next layers together, not ten."""
    run = synthetic_run("contact.friction=0.1", "pinion.face_width_mm=22.5", file="demos/he2022.toml")
    edges = layer_edges(run.flank.z)
    part, own = 10.0 - edges[-2], edges[-2] - edges[-3]
    assert 0.0 < part < 0.5 * (edges[-1] - edges[-2]) and len(edges) == 9

    def load(z: Floats, _: int) -> Floats:
        return np.where(np.abs(z) > edges[-2], 1000.0, 100.0)

    found = face_load(loaded(run, load), 0)
    assert len(found.z) == 6 and found.ends[-1] == pytest.approx([edges[-3], 10.0])
    last = (1000.0 * part + 100.0 * own) / (part + own)
    assert found.factor() == pytest.approx(last / (100.0 + 900.0 * part / 10.0), rel=1e-9)


def test_plane_strain_has_no_other_load_than_the_mean() -> None:
    """Exact: 1 and not a rounding error more, without error bars of any kind."""
    run = synthetic_run("contact.friction=[0.0, 0.1]", file="demos/he2022.toml")
    assert [row.face_load_factor for row in friction_rows(run)] == [1.0, 1.0]
    assert [errors.face_load_factor for errors in errors_between(run, run)] == [0.0, 0.0]
    assert spacing_errors(run, 0).face_load_factor == 0.0


def test_load_of_one_mesh_is_averaged_over_the_layers_of_another() -> None:
    """Exact: a load of 1, 3, 2, 2 over four layers is 2 and 2 over pairs of them, 7/3 over the middle half with a
    quarter of the first layer; on its own layers it is itself."""
    edges = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    face = FaceLoad(np.column_stack([edges[:-1], edges[1:]]), np.array([[1.0, 3.0, 2.0, 2.0]]), np.array([2.0]))
    np.testing.assert_allclose(face.on_layers(face.ends), face.relative())
    assert face.on_layers(np.array([[-2.0, 0.0], [0.0, 2.0]])) == pytest.approx([1.0, 1.0])
    assert face.on_layers(np.array([[-1.25, 0.5]])) == pytest.approx([(0.25 * 1.0 + 3.0 + 0.5 * 2.0) / 1.75 / 2.0])


def test_errors_grow_with_what_meshes_and_positions_do_not_know() -> None:
    """Problem: a linear load over the face, the same at all positions and on a companion of half the slope. Exact: no
    error of the spacing; of the mesh at least the difference of both factors. A load that moves to and fro over the
    pitch, thinned to every other of six positions, is off by at most a tenth of its sway."""
    run = helical()
    b = run.pair.face_width
    steep = loaded(run, lambda z, _: 100.0 * (1.0 + 0.8 * z / b))
    flat = loaded(run, lambda z, _: 100.0 * (1.0 + 0.4 * z / b))
    apart = face_load(steep, 0).factor() - face_load(flat, 0).factor()
    (errors,) = errors_between(steep, flat)
    assert apart - 1e-9 <= errors.face_load_factor < 2.0 * apart
    assert errors_between(steep, steep)[0].face_load_factor < 1e-9
    assert spacing_errors(steep, 0).face_load_factor < 1e-9

    def moving(z: Floats, position: int) -> Floats:
        return 100.0 * (1.0 + (0.8 + 0.4 * np.cos(2.0 * np.pi * position / len(run.positions))) * z / b)

    assert 1e-3 < spacing_errors(loaded(run, moving), 0).face_load_factor < 0.1
    alone = loaded(run, moving)
    assert np.isnan(spacing_errors(replace(alone, positions=alone.positions[:1]), 0).face_load_factor)


def test_ripple_that_positions_leave_along_the_face_is_an_error() -> None:
    """Problem: a mean load with a ripple of 0.2 over the face, and one of 0.1 between its crests that alternates from
    position to position. Exact: every other position has a largest load that is larger by 0.024 only, but another
    curve over the face: 1.2 times 0.1/√2, over the root mean square of the load, 1.01."""
    run = helical()
    b = run.pair.face_width

    def load(z: Floats, position: int) -> Floats:
        place = 6.0 * np.pi * z / b
        return 100.0 * (1.0 + 0.2 * np.cos(place) + 0.1 * (-1.0) ** position * np.sin(place))

    assert spacing_errors(loaded(run, load), 0).face_load_factor == pytest.approx(0.084, rel=0.1)


def narrow(*settings: str) -> Scene:
    """A narrow helical pair."""
    return load_scene(SCENES / "narrow_helical.toml", [*COARSE, *settings])


def test_misalignment_makes_the_load_over_the_face_uneven() -> None:
    """Problem: a narrow helical pair, aligned and open by 20 µm at z > 0. The load moves to z < 0, and K is larger by
    more than the error bars of the aligned pair, which are there."""
    scenes = [narrow(f"pair.misalignment_um={gap}") for gap in (0.0, 20.0)]
    runs = [solved(scene) for scene in scenes]
    even, open_at_top = (face_load(run, 0) for run in runs)
    slope, tilted = (float(np.polyfit(each.z, each.relative(), 1)[0]) for each in (even, open_at_top))
    assert abs(slope) < 0.02 and tilted < -0.1
    (mesh,) = errors_between(runs[0], solved(scenes[0], companion_mesh))
    bar = mesh.face_load_factor + spacing_errors(runs[0], 0).face_load_factor
    assert 0.0 < bar < open_at_top.factor() - even.factor()
    assert 1.0 < friction_rows(runs[0])[0].face_load_factor == even.factor() < 1.15


def test_spur_pair_without_modification_bears_evenly() -> None:
    """Problem: a spur pair, its pinion wider than the wheel, whose ends press into it. At mid-face the load is the mean
    within 4 %, at the ends it is larger by less than a tenth."""
    load = face_load(solved(narrow("pair.helix_angle_deg=0", "pinion.face_width_mm=7")), 0)
    relative = load.relative()
    assert np.abs(relative[1:-1] - 1.0).max() < 0.04
    assert 1.0 < relative[0] < 1.1 and relative[-1] == pytest.approx(relative[0], rel=0.01)
    assert load.ends[[0, -1], [0, 1]] == pytest.approx([-3.0, 3.0])
