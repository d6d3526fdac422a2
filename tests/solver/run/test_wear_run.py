"""A scene with [wear] from the command line: ranks, resuming, and worn pairs that are scenes of their own."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from evolvent.commands.app import Exit
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.results.archive.archive import Archive
from evolvent.scene.scene import load_scene
from evolvent.wear.results.archive import read_checkpoint
from evolvent.wear.results.report import read_worn
from evolvent_meshes.arrays import Floats
from tests.support.gear_cases import HELICAL
from tests.support.running.processes import BROKEN_RUN, RunScript
from tests.support.running.samples import sampled

SPUR = "demos/he2022.toml"
QUIET = (
    "--quiet", "--set", "output.pictures=false", "--set", "output.animation=false", "--set", "output.fields=false",
    "--set", "output.error_bars=false",
)
SHORT = ("--level", "quick", "--set", "sweep.positions=5")
WEAR = (
    "--set", "wear.cycles=4e5", "--set", "wear.pinion_mm2_per_N=1e-10", "--set", "wear.wheel_mm2_per_N=3e-10",
    "--set", "wear.report_at_cycles=1e5", "--set", "wear.first_block_cycles=2e4",
)


def computed(
    run_script: RunScript, out: Path, *settings: str, how: str = "ok", ranks: int = 1, scene: str = SPUR
) -> int:
    """The status of a run."""
    done = run_script(BROKEN_RUN, how, scene, "--out", str(out), *QUIET, *settings, ranks=ranks)
    assert how != "ok" or done.returncode == 0, done.stderr
    return done.returncode


def blocks(out: Path) -> Floats:
    """wear.csv without how many positions were searched and how often the meshes followed since the start."""
    with open(out / "wear.csv", encoding="utf-8") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    return np.array([[value for name, value in row.items() if name not in ("searched", "refreshed")] for row in rows])


def depths(out: Path, cycles: str) -> list[Floats]:
    """Of pinion and wheel [mm]."""
    return [FlankChart.read(out / f"worn_{cycles}" / f"flank_{name}.csv").depth for name in ("pinion", "wheel")]


def assert_same(one: Path, other: Path, tolerance: float) -> None:
    """Blocks within the tolerance, depths within it of the largest one."""
    assert blocks(one) == pytest.approx(blocks(other), rel=tolerance, abs=tolerance)
    for cycles in ("100000", "400000"):
        for a, b in zip(depths(one, cycles), depths(other, cycles)):
            assert np.abs(a - b).max() < tolerance * b.max()


@pytest.fixture(scope="module")
def worn_pair(run_script: RunScript, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of He's pair worn to 400,000 cycles on one rank, without friction; only to be read."""
    out = tmp_path_factory.mktemp("worn") / "out"
    computed(run_script, out, *SHORT, *WEAR)
    return out


@pytest.fixture(scope="module")
def followed(run_script: RunScript, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same with meshes that follow the wear; only to be read."""
    out = tmp_path_factory.mktemp("followed") / "out"
    computed(run_script, out, *SHORT, *WEAR, "--set", "wear.refresh_um=0.2")
    return out


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.mpi
@pytest.mark.parametrize("friction", ["0.0", "0.1"])
def test_wear_does_not_depend_on_ranks(friction: str, worn_pair: Path, run_script: RunScript, tmp_path: Path) -> None:
    """He's pair without and with friction, K/H three times as large on the wheel, on 1, 2 and 4 ranks: the same blocks
    and depths within 1e-8."""
    settings = (*SHORT, *WEAR, "--set", f"contact.friction={friction}")
    alone = worn_pair if friction == "0.0" else tmp_path / "1"
    if alone != worn_pair:
        computed(run_script, alone, *settings)
    for ranks in (2, 4):
        computed(run_script, tmp_path / str(ranks), *settings, ranks=ranks)
        assert_same(tmp_path / str(ranks), alone, 1e-8)


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.mpi
@pytest.mark.parametrize("how", ["kill-before-18", "full-14"])
def test_interrupted_wear_study_is_resumed(how: str, followed: Path, run_script: RunScript, tmp_path: Path) -> None:
    """Killed while the fourth block is written, or the disk full at the second; resumed on two ranks, the meshes
    following the wear in between: the same as never stopped within 1e-8. Resumed once more nothing is left to do."""
    whole, halves = followed, tmp_path / "halves"
    settings = (*SHORT, *WEAR, "--set", "wear.refresh_um=0.2")
    assert computed(run_script, halves, *settings, how=how) != Exit.DONE
    kept = read_checkpoint(Archive(halves, load_scene(halves / "scene.toml")))
    assert kept is not None and 1 <= len(kept.rows) < len(blocks(whole))
    computed(run_script, halves, *settings, "--resume", ranks=2)
    assert_same(halves, whole, 1e-8)
    assert "the meshes have followed" in (halves / "run.log").read_text(encoding="utf-8")
    before = (halves / "wear.json").read_text(encoding="utf-8")
    computed(run_script, halves, *settings, "--resume")
    assert (halves / "wear.json").read_text(encoding="utf-8") == before
    assert "resumed after 400000 of 400000 cycles" in (halves / "run.log").read_text(encoding="utf-8")


def test_wear_study_of_another_scene_is_not_resumed(worn_pair: Path, run_script: RunScript, tmp_path: Path) -> None:
    """With another K/H: status 2, and what was there stays."""
    out = shutil.copytree(worn_pair, tmp_path / "out")
    more = (*SHORT, *WEAR, "--set", "wear.wheel_mm2_per_N=4e-10", "--resume")
    assert computed(run_script, out, *more, how="as-is") == Exit.BAD_INPUT
    assert blocks(out) == pytest.approx(blocks(worn_pair))


def test_worn_pair_is_solved_from_its_own_scene(worn_pair: Path, run_script: RunScript, tmp_path: Path) -> None:
    """The worn pair solved from its own scene: the same transmission error within 3e-4 of the wear, on a finer mesh
    within 2 % of it; and less its mean it is not what it was at the beginning. Its folder is a run to which nothing is
    left to add."""
    worn = worn_pair / "worn_400000"
    own = load_scene(worn / "scene.toml")
    assert Archive(worn, own).read_sweep(own.gear_pair())[-1].closes
    computed(run_script, tmp_path / "again", scene=str(worn / "scene.toml"))
    computed(run_script, tmp_path / "finer", "--level", "standard", scene=str(worn / "scene.toml"))
    found = {name: errors(folder) for name, folder in (
        ("worn", worn), ("again", tmp_path / "again"), ("finer", tmp_path / "finer"), ("new", worn_pair))}
    wear = 1e3 * max(depth.max() for depth in depths(worn_pair, "400000"))
    assert np.abs(found["again"] - found["worn"]).max() < 3e-4 * wear
    assert np.abs(found["finer"] - found["worn"]).max() < 2e-2 * wear
    assert np.ptp(found["worn"] - found["new"]) > 0.1 * wear


def errors(out: Path) -> Floats:
    """Transmission errors [µm]."""
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    return np.array([position["transmission_error_um"] for position in summary["positions"]])


def test_wear_continues_from_flank_charts(worn_pair: Path, run_script: RunScript, tmp_path: Path) -> None:
    """Worn to 100,000 cycles and, from the charts that it left, on to 400,000, against one study: depths within the
    errors of the blocks."""
    scene = worn_pair / "worn_100000" / "scene.toml"
    more = ("--set", "wear.cycles=3e5", "--set", "wear.pinion_mm2_per_N=1e-10", "--set", "wear.wheel_mm2_per_N=3e-10")
    computed(run_script, tmp_path / "two", *more, scene=str(scene))
    study = read_worn(tmp_path / "two")
    for gear, (a, b) in enumerate(zip(depths(worn_pair, "400000"), depths(tmp_path / "two", "300000"))):
        assert np.abs(a - b).sum() < 0.05 * a.sum()
        assert study.pairs[-1].worn[gear].depth.max() < b.max()  # what was there before is not the study's


@pytest.mark.slow
@pytest.mark.parametrize("blocks_", sampled(["explicit", "implicit"]))
def test_helical_pair_wears_in_the_ratio_of_coefficients(blocks_: str, run_script: RunScript, tmp_path: Path) -> None:
    """A coarse helical pair in 3D with friction: depths nowhere negative, both gears' volumes in the ratio of their
    K/H and of how often a tooth meets, and the map of the worn flanks drawn where pictures are asked for."""
    scene = tmp_path / "helical.toml"
    scene.write_text(HELICAL, encoding="utf-8")
    settings = (
        *WEAR, "--set", "contact.friction=0.1", "--set", "sweep.positions=4", "--set", f"wear.blocks={blocks_}",
        "--set", "wear.cycles=1.2e5",
    )
    out = tmp_path / "out"
    drawn = blocks_ == "implicit"
    computed(run_script, out, *settings, "--set", f"output.pictures={str(drawn).lower()}", scene=str(scene))
    study = read_worn(out)
    last = study.pairs[-1]
    assert min(chart.depth.min() for chart in last.worn) > -1e-6 * max(chart.depth.max() for chart in last.worn)
    assert last.volumes[1] / last.volumes[0] == pytest.approx(3.0 * 20.0 / 24.0, rel=1e-9)
    assert (out / "pictures" / "21_wear_map.png").is_file() == drawn
