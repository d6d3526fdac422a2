"""A whole run of a scene whose flanks have levels of their own: output, resuming, ranks, and the same on one mesh.

A narrow helical pair on second-order cells, too small for levels by default: they are made to apply whatever the size.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista

from evidence.benchmarks.gears.skips import differences
from evolvent.gears.meshing import levelled_meshes
from evolvent.results.archive.archive import COARSE, Archive
from evolvent.results.archive.store import ArchiveError
from evolvent.results.run_data import read_run
from evolvent.run.kinds.run import Run
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene, scene_from_text
from evolvent.scene.skips import skip_named
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import HELICAL
from tests.support.running.processes import BROKEN_RUN, RunScript

SMALL = (
    "mesh.order=2", "mesh.elements_per_contact_width=0.8", "pinion.face_width_mm=4", "wheel.face_width_mm=4",
    "contact.friction=[0.1]", "pinion.tip_relief_um=8",
)
EVERYTHING = ("output.deformation=true", "output.animation=false")
BARE = ("output.pictures=false", "output.animation=false", "output.fields=false", "output.error_bars=false")


def small_scene(*settings: str) -> Scene:
    return scene_from_text(HELICAL, [*SMALL, *settings])


def summary_of(out: Path) -> dict[str, Any]:
    read: dict[str, Any] = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    return read


@pytest.fixture(scope="module")
def levels() -> Any:
    """Levels whatever the size of the mesh."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(levelled_meshes, "MOST_DOFS", 0)
        yield


@pytest.fixture(scope="module")
def out(levels: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run with everything that a scene may ask for but the animation."""
    folder = tmp_path_factory.mktemp("levels") / "out"
    quietly(Run.of(small_scene(*EVERYTHING)), folder)
    return folder


@pytest.mark.slow
def test_output_is_complete(out: Path) -> None:
    """Tables, pictures, ParaView fields and error bars; the skip is named, and the fine flanks' size."""
    summary = summary_of(out)
    assert "two-level" in {skip["name"] for skip in summary["skipped"]}
    bars = summary["frictions"][0]["estimated_error"]
    assert summary["estimated_error"]["missing"] is None
    assert bars["transmission_error_peak_to_peak_um"] > 0.0 and bars["max_pressure_MPa"] > 0.0
    assert (out / "pictures/04_stress_of_teeth.png").stat().st_size > 10_000
    assert not any("could not" in line for line in (out / "run.log").read_text(encoding="utf-8").splitlines())
    run = read_run(out)
    assert summary["flank_dofs"] == 3 * sum(len(shape.flank_nodes) for shape in run.shapes)
    assert summary["dofs"] == 3 * sum(len(shape.points) - len(shape.flank_nodes) for shape in run.shapes)


@pytest.mark.slow
def test_fields_are_on_the_fine_flank(out: Path) -> None:
    """The flanks that ParaView reads have a point for each node of the finest level, and pressures on them."""
    run = read_run(out)
    grid = pyvista.read(out / "fields/flanks_0000.vtp")
    nodes = [len(shape.flank_nodes) for shape in run.shapes]
    teeth = [len(np.unique(grid.point_data["tooth"][grid.point_data["gear"] == gear])) for gear in (0, 1)]
    assert grid.n_points == teeth[0] * nodes[0] + teeth[1] * nodes[1]
    name = next(name for name in grid.point_data if name.startswith("pressure_MPa"))
    assert 100.0 < np.nanmax(grid.point_data[name]) < 5000.0


@pytest.mark.slow
def test_deformation_is_of_the_coarse_sector(out: Path) -> None:
    """The thin discs bend by a tenth of a millimetre, the bore rests."""
    grid = pyvista.get_reader(str(out / "fields/deformed.pvd")).read()[0]
    size = np.linalg.norm(grid.point_data["displacement_mm"], axis=1)
    assert 1e-3 < size.max() < 0.2 and size.min() == 0.0


@pytest.mark.slow
def test_a_finished_run_is_resumed_without_condensing(
    out: Path, levels: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same tables; on other meshes, those of one level, the archive is refused."""
    folder = tmp_path / "out"
    shutil.copytree(out, folder)
    scene = load_scene(folder / "scene.toml", ["output.deformation=false", *BARE[:3]])
    quietly(Run.of(scene), folder, resume=True, prepare=lambda *_: pytest.fail("condensed again"))
    assert summary_of(folder)["positions"] == summary_of(out)["positions"]
    assert summary_of(folder)["dofs"] == summary_of(out)["dofs"]
    monkeypatch.setattr(levelled_meshes, "MOST_DOFS", 10**9)
    with pytest.raises(ArchiveError, match="on others"):
        quietly(Run.of(scene), folder, resume=True)


@pytest.mark.slow
def test_one_mesh_gives_the_same_within_a_hundredth(out: Path, levels: None, tmp_path: Path) -> None:
    """Transmission error and torques within 1 %; pressures on less than one element a contact width are worth
    nothing."""
    scene = small_scene(*BARE, 'exact.parts=["two-level"]')
    assert gear_problem(scene).mesh.two_level is False
    quietly(Run.of(scene), tmp_path / "out")
    summary = summary_of(tmp_path / "out")
    assert "two-level" not in {skip["name"] for skip in summary["skipped"]} and summary["flank_dofs"] == 0
    found = differences(summary_of(out), summary)
    assert max(found.transmission_error, found.torque_ratio, found.loss) < 0.01 < skip_named("two-level").tolerance
    assert "not skipped: two-level\n" in (tmp_path / "out/run.log").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_companion_is_twice_as_coarse_in_levels(out: Path) -> None:
    """Half of the rows and of the layers of the run's finest level, and coarser sectors."""
    run = read_run(out)
    companion = Archive(out, run.scene, part=COARSE).read_gears()
    for fine, coarse in zip(run.shapes, companion):
        assert 2 * len(fine.facets["flank"]) / 9 < len(coarse.facets["flank"]) < 2 * len(fine.facets["flank"]) / 5
        assert len(coarse.points) < 0.4 * len(fine.points)


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.mpi
def test_ranks_and_resumed_runs_agree(out: Path, run_script: RunScript, tmp_path: Path) -> None:
    """Killed on one rank after a position, gone on with on two ranks: as on one rank within 1e-6."""
    scene, folder = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(small_scene(*BARE).resolved_toml(), encoding="utf-8")
    killed = run_script(BROKEN_RUN, "levels-4", str(scene), "--out", str(folder), "--quiet")
    assert killed.returncode != 0 and not (folder / "summary.json").exists()
    done = run_script(BROKEN_RUN, "levels", str(scene), "--out", str(folder), "--quiet", "--resume", ranks=2)
    assert done.returncode == 0, done.stderr
    assert "resumed after 1 positions" in (folder / "run.log").read_text(encoding="utf-8")
    found, wanted = summary_of(folder), summary_of(out)
    assert found["ranks"] == 2
    for one, other in zip(found["positions"], wanted["positions"], strict=True):
        for name in ("transmission_error_um", "max_pressure_MPa", "torque_gear_Nm"):
            assert one[name] == pytest.approx(other[name], rel=1e-6)
