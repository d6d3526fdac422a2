"""A run at an operating speed from the command line: its load, ranks; a worn pair that vibrates, killed twice."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.commands.app import Exit
from evolvent.results.archive.archive import Archive
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.run.dynamics.bodies import elastic_point
from evolvent.run.kinds.wear import Wear
from evolvent.scene.scene import load_scene
from evolvent.wear.results.archive import read_checkpoint
from evolvent_meshes.arrays import Floats
from tests.support.checkout import ROOT
from tests.support.running.processes import BROKEN_RUN, RunScript

SCENE, VIBRATING = "demos/he2022_wear.toml", ROOT / "demos/he2022_dynamics.toml"
OUTPUT = tuple(f"output.{name}=false" for name in ("pictures", "animation", "fields", "error_bars"))
SETTINGS = (
    *OUTPUT, "sweep.positions=8", "dynamics.torque_percents=[25,100,200]", "wear.cycles=4e5",
    "wear.report_at_cycles=1e5", "wear.first_block_cycles=4e4", "wear.refresh_um=0.3",
)

LAST_DIGIT = 2e-8
"""Of the nine that tables have: a rounding of it, and one more of a number that is just above a power of ten."""


def computed(run_script: RunScript, out: Path, *words: str, how: str = "ok", ranks: int = 1) -> int:
    """The status of a run."""
    settings = [word for setting in SETTINGS for word in ("--set", setting)]
    done = run_script(BROKEN_RUN, how, SCENE, "--out", str(out), "--quiet", *settings, *words, ranks=ranks)
    assert how != "ok" or done.returncode == 0, done.stderr
    return done.returncode


def columns(path: Path, *without: str) -> dict[str, Floats]:
    """The columns of a table."""
    with open(path, encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0] if name not in without}


@pytest.fixture(scope="module")
def whole(run_script: RunScript, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of He's pair worn at 2000 r/min on one rank; only to be read."""
    out = tmp_path_factory.mktemp("operating") / "out"
    computed(run_script, out)
    return out


def assert_same(one: Path, other: Path, tolerance: float) -> None:
    """Vibration after each block, and blocks but for how many positions were searched since the start."""
    for name, without in (("vibration.csv", ()), ("wear.csv", ("searched", "refreshed"))):
        found, wanted = (columns(folder / name, *without) for folder in (one, other))
        for column, values in wanted.items():
            assert found[column] == pytest.approx(values, rel=tolerance, abs=tolerance), column


def test_picture_of_the_mesh_force_is_drawn_from_tables(whole: Path) -> None:
    """One of those that `evolvent plot` draws, though the scene asks for none."""
    (picture,) = from_tables(Wear.outputs.pictures, whole)
    assert picture.name == "30_mesh_force.png" and picture.draw().startswith(b"\x89PNG")


def test_positions_have_the_force_of_their_phase(whole: Path) -> None:
    """The unworn pair: at each position the torque on the pinion is the mesh force of histories.csv at its phase, times
    the base radius, to what linear interpolation between 240 and between 256 phases leaves; and the smallest and the
    largest one of operation.json enclose them."""
    positions, motion = columns(whole / "positions.csv", "tip_edge"), columns(whole / "histories.csv", "way")
    facts = json.loads((whole / "operation.json").read_text(encoding="utf-8"))
    phases = positions["pinion_angle_deg"] / 7.2
    force = 1e3 * positions["torque_pinion_Nm"] / (75.0 * np.cos(np.radians(20.0)))
    assert force == pytest.approx(np.interp(phases, motion["phase"], motion["force_N"]), rel=1e-3)
    assert facts["smallest_force_N"] * 0.999 < force.min() < force.max() < facts["largest_force_N"] * 1.001
    assert np.ptp(force) > 0.2 * facts["static_force_N"]


def test_rigid_bodies_are_said_in_a_run(whole: Path) -> None:
    """The demo of wear has the rigid bodies of its paper: the log says what that leaves out."""
    assert 'dynamics.bodies = "rigid": all inertia is at the bores' in (whole / "run.log").read_text(encoding="utf-8")


def test_a_pair_at_speed_has_the_bodies_of_its_scene() -> None:
    """`evolvent run` at an operating speed: elastic bodies by default, with the inertia that the scene gives, none
    where they are rigid; without such a speed there is no vibration."""
    bare = load_scene(VIBRATING, ["mesh.level=quick"])
    assert elastic_point(bare, MPI.COMM_SELF) is None
    at_speed = ["mesh.level=quick", "dynamics.operating_rpm=2000"]
    elastic, rigid = (
        elastic_point(load_scene(VIBRATING, [*at_speed, *more]), MPI.COMM_SELF)
        for more in ([], ['dynamics.bodies="rigid"'])
    )
    assert elastic is not None and rigid is not None and rigid.settings.bodies is None
    assert elastic.settings.bodies is not None and replace(elastic.settings, bodies=None) == rigid.settings


def test_each_report_is_a_scene_of_its_own(whole: Path) -> None:
    """The worn pair keeps its operating speed, so that it is solved under it again."""
    text = (whole / "worn_100000" / "scene.toml").read_text(encoding="utf-8")
    assert "operating_rpm = 2000" in text and "flank_csv" in text


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.mpi
def test_wear_with_vibration_does_not_depend_on_ranks(whole: Path, run_script: RunScript, tmp_path: Path) -> None:
    """On two ranks: blocks and vibration within 1e-6."""
    computed(run_script, tmp_path / "out", ranks=2)
    assert_same(tmp_path / "out", whole, 1e-6)


@pytest.mark.evidence
@pytest.mark.slow
def test_killed_twice_and_resumed(whole: Path, run_script: RunScript, tmp_path: Path) -> None:
    """Killed while a block is written, resumed and killed again: depths and vibration as never stopped within 1e-9,
    tables to their last digit."""
    out = tmp_path / "out"
    assert computed(run_script, out, how="kill-before-26") != Exit.DONE
    first = len(columns(out / "vibration.csv")["cycles"])
    assert computed(run_script, out, "--resume", how="kill-before-34") != Exit.DONE
    second = len(columns(out / "vibration.csv")["cycles"])
    assert 1 <= first < second < len(columns(whole / "vibration.csv")["cycles"])
    computed(run_script, out, "--resume")
    one, other = (read_checkpoint(Archive(folder, load_scene(folder / "scene.toml"))) for folder in (out, whole))
    assert one is not None and other is not None and one.vibration is not None and other.vibration is not None
    assert np.abs(one.depth - other.depth).max() < 1e-9 * other.depth.max()
    assert one.vibration.state == pytest.approx(other.vibration.state, rel=1e-9)
    assert_same(out, whole, LAST_DIGIT)


def test_a_mesh_that_is_a_stiffness_has_no_heaviest_torque(run_script: RunScript, tmp_path: Path) -> None:
    """Worn with the tangent stiffness times the deflection: kept and read again, NaN in the table, null in the file."""
    out = tmp_path / "out"
    computed(run_script, out, "--set", "dynamics.mesh=tangent", "--set", "wear.cycles=2e4", "--set",
             "wear.report_at_cycles=[]", "--set", "wear.first_block_cycles=2e4")
    assert np.isnan(columns(out / "vibration.csv")["heaviest_torque_share"]).all()
    assert json.loads((out / "operation.json").read_text(encoding="utf-8"))["heaviest_torque_share"] is None
