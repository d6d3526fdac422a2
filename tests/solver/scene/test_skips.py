"""What a scene does not need: each skip leaves something out, and the answer stays the same within its tolerance."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

from evidence.benchmarks.gears.skips import CASES, differences
from evolvent.check.check_report import overview
from evolvent.commands.app import main
from evolvent.gears import meshed_sector
from evolvent.gears.full_gear import WholeGear
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch
from evolvent.gears.sweep.position_search import shared_position
from evolvent.results.archive.archive import fingerprint
from evolvent.run.kept_pitch import pitch_of
from evolvent.run.kinds.run import Run
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene, scene_from_text
from evolvent.scene.schema.output import SkipName
from evolvent.scene.skips import SKIPS, one_mesh_reason, skip_named, skipped, switched_off
from evolvent_meshes.gears.member import Member
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import HELICAL, helical_scene, model_of
from tests.support.running.patches import calling_first
from tests.support.running.processes import RunScript
from tests.support.scene_texts import WEAR

SPUR = ("pair.helix_angle_deg=0", "mesh.order=2", "mesh.elements_per_contact_width=2")
SMOOTH = "contact.friction=0"


@dataclass(frozen=True)
class Case:
    """A scene to which a skip applies."""

    skip: SkipName
    settings: tuple[str, ...]

    def scene(self, off: bool) -> Scene:
        """With the skip, or with it switched off."""
        return helical_scene(*self.settings, *([f"exact.parts=[{json.dumps(self.skip)}]"] if off else []))


WIDE = ("pinion.face_width_mm=16", "wheel.face_width_mm=16", "load.torque_Nm=1000")
ANSWERS = {
    "plane": Case("plane", (*SPUR, SMOOTH, *WIDE, "mesh.order=1", "mesh.elements_per_contact_width=1.7")),
    "friction-terms": Case("friction-terms", SPUR),
    "friction-terms, none needed": Case("friction-terms", (*SPUR, SMOOTH)),
    "one-pitch": Case("one-pitch", (*SPUR, "sweep.positions=4")),
    "one-pitch, long remembered": Case("one-pitch", ("contact.friction=[0.0, 0.5]", "sweep.positions=6")),
    "one-sector": Case("one-sector", SPUR),
    "far-teeth": Case("far-teeth", SPUR),
    "window": Case("window", SPUR),
    "deflected-flanks": Case("deflected-flanks", SPUR),
    "coarse-body": Case("coarse-body", SPUR),
    "reuse": Case("reuse", SPUR),
    "fields": Case("fields", (*SPUR, SMOOTH)),
    "pictures": Case("pictures", (*SPUR, SMOOTH)),
    "error-bars": Case("error-bars", (*SPUR, SMOOTH)),
}


CLOSER = {"deflected-flanks": 1.2e-2, "one-pitch": 1e-4}
"""Where a case of ours bears little on tip edges, or soon forgets where it began, and the skip's tolerance is that of a
pair which does not."""


def solved(scene: Scene, out: Path) -> dict[str, Any]:
    """The summary of a run."""
    quietly(Run.of(scene), out)
    summary: dict[str, Any] = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    return summary


@pytest.fixture(scope="module")
def solved_case(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, bool], tuple[dict[str, Any], Path]]:
    """Summary and folder of a case of ANSWERS, with its skip or without; each scene is solved once."""

    @cache
    def solved_once(text: str) -> tuple[dict[str, Any], Path]:
        out = tmp_path_factory.mktemp("case") / "out"
        return solved(scene_from_text(text), out), out

    return lambda name, off: solved_once(ANSWERS[name].scene(off).resolved_toml())


@pytest.mark.parametrize("name", ANSWERS)
def test_the_answer_stays(name: str, solved_case: Callable[[str, bool], tuple[dict[str, Any], Path]]) -> None:
    """Transmission error, peak pressure, torque ratio and loss with a skip = those computed the long way, within the
    skip's tolerance, at every position, and whatever the pitch."""
    case = ANSWERS[name]
    (short, _), (long, folder) = (solved_case(name, off) for off in (False, True))
    found = differences(short, long)
    assert found.largest <= min(skip_named(case.skip).tolerance, CLOSER.get(name, np.inf)), found
    assert case.skip in {skip["name"] for skip in short["skipped"]}
    assert case.skip not in {skip["name"] for skip in long["skipped"]}
    assert long["scene"]["exact"]["parts"] == [case.skip]
    assert f"not skipped: {case.skip}\n" in (folder / "run.log").read_text(encoding="utf-8")


def test_every_skip_is_tested_and_measured() -> None:
    """The registry, the scene's key, the tests and the benchmark name the same skips."""
    names = [skip.name for skip in SKIPS]
    assert tuple(names) == get_args(SkipName)
    elsewhere = {"two-level"}  # tests/solver/run/test_two_level_run.py
    assert set(names) == {case.skip for case in ANSWERS.values()} | elsewhere == {case.skip for case in CASES}


def contact_nodes(scene: Scene) -> int:
    """Pinion flank nodes whose jump is an unknown at φ = 0."""
    return len(shared_position(model_of(scene), 0.0, (0.0, 0.0), (0.0,), None).contact.geometry.node)


def components(scene: Scene) -> int:
    """Compliance rows a node at the first position."""
    model = model_of(scene)
    return shared_position(model, 0.0, (0.0, 0.0), scene.contact.friction, None).system.k


def histories(scene: Scene) -> int:
    """How many friction coefficients have a history after the first position."""
    frictions = scene.contact.friction
    swept = next(sweep_pitch(model_of(scene), pitch_of(scene), frictions, initial_state(frictions)))
    return sum(history is not None for history in swept.state.histories)


COUNTED: dict[SkipName, tuple[tuple[str, ...], Callable[[Scene], int], int, int]] = {
    "plane": (SPUR, lambda scene: gear_mesh(gear_problem(scene), Member.PINION).dimension, 2, 3),
    "one-pitch": ((SMOOTH,), lambda scene: len(pitch_of(scene).angles), 2, 4),
    "far-teeth": ((SMOOTH,), lambda scene: len(gear_problem(scene).contact_teeth), 4, 20),
}
"""A skip, settings, what it changes, and that with the skip and without."""


@pytest.mark.parametrize("name", COUNTED)
def test_the_switch_switches(name: SkipName) -> None:
    """Without the skip there are more dimensions, positions or teeth, as many as there should be."""
    settings, count, short, long = COUNTED[name]
    case = Case(name, settings)
    assert (count(case.scene(off=False)), count(case.scene(off=True))) == (short, long)


def test_friction_terms_are_kept() -> None:
    """Without the skip μ = 0 has tangential components and a history, as μ = 0.3 has."""
    case = Case("friction-terms", (*SPUR, SMOOTH))
    assert [(components(case.scene(off)), histories(case.scene(off))) for off in (False, True)] == [(1, 0), (2, 1)]


def test_the_whole_flank_is_searched() -> None:
    """Without the window every node of the flank is there, also of pairs that only face each other."""
    case = Case("window", SPUR)
    nodes = len(model_of(case.scene(off=True)).bodies[0].flank.points)
    assert contact_nodes(case.scene(off=False)) < nodes
    assert contact_nodes(case.scene(off=True)) > nodes


def test_the_whole_gear_is_factored() -> None:
    """Without the skip the compliance is that of z sectors in one mesh."""
    case = Case("one-sector", SPUR)
    short, long = (model_of(case.scene(off)) for off in (False, True))
    assert all(isinstance(body.chain, ChainedCompliance) for body in short.bodies)
    assert all(isinstance(body.chain, WholeGear) for body in long.bodies)


def test_the_body_is_refined() -> None:
    """Without the skip the back flank has the loaded flank's elements, and the bore three times as many radially."""
    case = Case("coarse-body", SPUR)
    short, long = (gear_mesh(gear_problem(case.scene(off)), Member.PINION) for off in (False, True))
    assert len(long.facets["flank"]) == len(short.facets["flank"]) > len(short.facets["back"]) - 5
    assert len(long.facets["back"]) == len(long.facets["flank"]) + 15
    assert len(long.facets["cut_low"]) > 2.5 * len(short.facets["cut_low"])


def test_gears_are_condensed_again(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Without reuse both gears are condensed for each of two friction coefficients."""
    made: list[int] = []
    counted = calling_first(meshed_sector.condensed_gear, lambda *_, **__: made.append(1))
    monkeypatch.setattr(meshed_sector, "condensed_gear", counted)
    counts = []
    for off in (False, True):
        made.clear()
        solved(Case("reuse", SPUR).scene(off), tmp_path / str(off))
        counts.append(len(made))
    assert counts == [2, 4]


@pytest.mark.parametrize(
    ("name", "pattern"),
    [("fields", "fields/*"), ("pictures", "pictures/*.png"), ("error-bars", "results/errors.npz")],
)
def test_output_is_written(
    name: str, pattern: str, solved_case: Callable[[str, bool], tuple[dict[str, Any], Path]]
) -> None:
    """Nothing unless it is switched on; summary.json still tells the scene that was asked for."""
    for off in (False, True):
        summary, out = solved_case(name, off)
        assert bool(list(out.glob(pattern))) == off
        assert summary["scene"]["output"]["fields"] is False


def test_what_does_not_apply_is_not_switched_off() -> None:
    """A helical scene is never plane: its skip is neither made nor called off."""
    scene = helical_scene('exact.parts=["plane", "window"]')
    assert "plane" not in {skip.name for skip in skipped(scene)}
    assert switched_off(scene) == ["window"]


def test_resuming_wants_the_same_skips() -> None:
    """The set is part of what results depend on, its order and what concerns output only is not; the resolved scene
    keeps it."""
    scene = helical_scene('exact.parts=["window", "one-pitch"]')
    assert scene_from_text(scene.resolved_toml()) == scene
    assert fingerprint(scene) != fingerprint(helical_scene())
    assert fingerprint(scene) == fingerprint(helical_scene('exact.parts=["one-pitch", "fields", "window"]'))


def test_why_a_large_pair_has_one_mesh_is_said() -> None:
    """A large pair whose flanks wear, or a crowned spur pair with long cells: `check` says that it has no levels, and
    of the former without wear, or of a small one, it does not."""
    large = load_scene("demos/yang2022.toml", ["contact.friction=0.1", *WEAR])
    assert one_mesh_reason(large) in overview(large) and "two-level" in one_mesh_reason(large)
    assert "two-level" not in {skip.name for skip in skipped(large)}
    assert switched_off(large) == []
    bare = load_scene("demos/yang2022.toml", ["contact.friction=0.1"])
    assert one_mesh_reason(bare) == "" and "two-level" in {skip.name for skip in skipped(bare)}
    assert one_mesh_reason(helical_scene("contact.friction=0.1", *WEAR)) == ""
    spur = load_scene("demos/he2022.toml", ["pinion.lead_crowning_um=8", "mesh.level='fine'"])
    assert one_mesh_reason(spur) in overview(spur) and "as long as high" in one_mesh_reason(spur)
    off = load_scene("demos/yang2022.toml", ['exact.parts=["two-level"]'])
    assert switched_off(off) == ["two-level"]


def test_unknown_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Status 2, and the message lists the names."""
    path = tmp_path / "scene.toml"
    path.write_text(HELICAL, encoding="utf-8")
    assert main(["run", str(path), "--out", str(tmp_path / "out"), "--exact", "window", "--exact", "plain"]) == 2
    message = capsys.readouterr().err
    assert 'exact.parts[1]: found "plain"' in message
    assert all(skip.name in message for skip in SKIPS)
    assert list(tmp_path.iterdir()) == [path]


def test_check_names_what_is_off(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`check` lists skips by name, and apart from them what is computed without."""
    path = tmp_path / "scene.toml"
    path.write_text(HELICAL, encoding="utf-8")
    assert main(["check", str(path), "--exact", "window"]) == 0
    made, off = capsys.readouterr().out.split("Computed without simplification\n")
    assert "  one-sector " in made
    assert "  window " not in made
    assert off.split("\n\n")[0].split() == ["window"]  # warnings come after it


@pytest.mark.mpi
def test_ranks_agree_the_long_way(run_script: RunScript, tmp_path: Path) -> None:
    """Whole gears, prepared again for each of two friction coefficients, on two ranks: as the usual way on one within
    1e-8."""
    scene = tmp_path / "spur.toml"
    scene.write_text(HELICAL, encoding="utf-8")
    quiet = [f"--set=output.{name}=false" for name in ("pictures", "animation", "fields")]
    spur = [*(f"--set={setting}" for setting in (*SPUR, "mesh.order=1")), *quiet, "--quiet"]
    summaries = []
    for ranks, more in ((1, ()), (2, ("--exact", "reuse", "--exact", "one-sector"))):
        out = tmp_path / str(ranks)
        done = run_script("-m", "evolvent", "run", str(scene), "--out", str(out), *spur, *more, ranks=ranks)
        assert done.returncode == 0, done.stderr
        summaries.append(json.loads((out / "summary.json").read_text(encoding="utf-8")))
    found = differences(*summaries)
    assert found.largest < 1e-8
    assert np.all([row["friction"] in (0.0, 0.3) for row in summaries[1]["positions"]])
