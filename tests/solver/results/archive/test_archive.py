"""What a run leaves on disk, whatever happens to it: killed, resumed, another scene's, a full disk."""

from __future__ import annotations

import json
import os
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.results.archive.archive import Archive, fingerprint
from evolvent.results.archive.store import ArchiveError, arrays_bytes, read_arrays
from evolvent.scene.scene import load_scene
from evolvent_meshes.files import write_bytes
from tests.support.gear_cases import helical_scene, model_of, spur_scene
from tests.support.running.processes import BROKEN_RUN, RunScript, on_ranks

SCENE = "demos/he2022.toml"
SETTINGS = (
    "--level", "quick", "--quiet", "--set", "contact.friction=[0.1, 0.3]", "--set", "sweep.positions=4", "--set",
    "output.pictures=false", "--set", "output.animation=false",
    "--set", "output.fields=false",
)


def arguments(out: Path, *more: str) -> tuple[str, ...]:
    return SCENE, "--out", str(out), *SETTINGS, *more


def assert_same(found: Path, wanted: Path) -> None:
    """All numbers of two runs agree within 1e-7 of the largest of their array. Two undisturbed runs differ by up to
    1e-9, what Newton's method leaves, for sums round differently where their arrays lie differently in memory."""
    one, other = (
        {
            f"{path.name}/{key}": array
            for path in (out / "results").glob("*.npz")
            for key, array in read_arrays(path).items()
        }
        for out in (found, wanted)
    )
    assert one.keys() == other.keys()
    for name, array in other.items():
        if name.endswith(("seconds", "residual", "iterations")):
            continue
        if array.dtype.kind != "f":
            np.testing.assert_array_equal(one[name], array, err_msg=name)
        else:
            np.testing.assert_allclose(
                one[name], array, rtol=0.0, atol=1e-7 * np.abs(array).max(initial=1e-6), err_msg=name
            )
    one_table, other_table = (table(out) for out in (found, wanted))
    assert one_table.keys() == other_table.keys()
    for name, value in other_table.items():
        assert one_table[name] == pytest.approx(value, rel=1e-7, abs=1e-9), name


def table(out: Path) -> dict[str, float]:
    """What summary.json says of every position but what depends on the clock or on rounding."""
    rows = json.loads((out / "summary.json").read_text(encoding="utf-8"))["positions"]
    names = ("torque_pinion_Nm", "torque_gear_Nm", "transmission_error_um", "max_pressure_MPa", "loss_percent")
    return {f"{name} {row['pinion_angle_deg']} {row['friction']}": row[name] for row in rows for name in names}


@pytest.fixture(scope="module")
def whole(run_script: RunScript, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that nothing happened to."""
    out = tmp_path_factory.mktemp("whole") / "out"
    done = run_script(BROKEN_RUN, "ok", *arguments(out))
    assert done.returncode == 0, done.stderr
    return out


def test_finished_run_has_all_its_files(whole: Path) -> None:
    """All files are there, none is half-written, and the log tells the positions: the pitch, and the first of it
    again, which closes it."""
    names = {path.name for path in (whole / "results").glob("*.npz")}
    own = {"gears.npz", "state.npz", *(f"position_{k:04d}.npz" for k in range(5))}
    assert names == {"errors.npz", *own, *(f"coarse_{name}" for name in own)}
    assert not list(whole.rglob("*.evolvent-part*"))
    assert (whole / "run.log").read_text(encoding="utf-8").count("balance") == 5


@pytest.mark.mpi
def test_killed_run_resumes_to_the_same_results(whole: Path, run_script: RunScript, tmp_path: Path) -> None:
    """kill -9 while meshing, before the gears are kept, amid writing a position, between a position and its state, and
    on two ranks at the position that closes the pitch: resumed after each, the run is the undisturbed one."""
    out = tmp_path / "out"
    struck = ("kill-mesh", 1, 0), ("kill-before-1", 1, 0), ("kill-half-4", 1, 1), ("kill-before-4", 1, 2), (
        "kill-before-3", 2, 3
    )
    for number, (how, ranks, complete) in enumerate(struck):
        done = run_script(BROKEN_RUN, how, *arguments(out, *["--resume"] * (number > 0)), ranks=ranks)
        assert done.returncode == (-9 if ranks == 1 else 137), done.stderr
        assert not (out / "summary.json").exists()
        assert kept_positions(out) == complete
    done = run_script(BROKEN_RUN, "ok", *arguments(out, "--resume"))
    assert done.returncode == 0, done.stderr
    assert_same(out, whole)


def kept_positions(out: Path) -> int:
    """Positions from which a run is resumed."""
    state = out / "results/state.npz"
    return int(read_arrays(state)["complete"]) if state.exists() else 0


def test_archived_friction_history_continues_the_sweep(tmp_path: Path) -> None:
    """Problem: two positions of a helical pair at μ = 0.3, parts of whose contact stick; on a spur pair all slides. The
    second one after the first as it was archived is the second one of the sweep; it is another one without a past."""
    scene, μ = helical_scene("contact.friction=0.3"), [0.3]
    model, pitch = model_of(scene), Pitch(tuple(np.radians([0.0, 0.5])))
    first, second = sweep_pitch(model, pitch, μ, initial_state(μ))
    archive = Archive(tmp_path, scene)
    archive.write_position(0, first)
    state = archive.read_state(scene.gear_pair())
    assert state is not None
    resumed, bare = (next(sweep_pitch(model, pitch, μ, past, begin=1)) for past in (state, initial_state(μ)))
    wanted = second.results[0].friction_loss
    assert resumed.results[0].friction_loss == pytest.approx(wanted, rel=1e-8)
    assert bare.results[0].friction_loss != pytest.approx(wanted, rel=1e-5)


def test_resuming_a_complete_run_solves_nothing(whole: Path, run_script: RunScript, tmp_path: Path) -> None:
    """--resume of a complete run condenses nothing, searches nothing, and writes the tables again; another title or
    other output is no other scene."""
    out = tmp_path / "out"
    shutil.copytree(whole, out)
    (out / "summary.json").unlink()
    done = run_script(BROKEN_RUN, "count", *arguments(out, "--resume", "--set", "title='again'"))
    assert done.returncode == 0, done.stderr
    assert "condensed 0, searched 0" in done.stdout
    assert_same(out, whole)
    assert 'title = "again"' in (out / "scene.toml").read_text(encoding="utf-8")


def snapshot(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("ranks", on_ranks(1, 2))
def test_resuming_another_scene_changes_nothing(ranks: int, whole: Path, run_script: RunScript) -> None:
    """Status 2, a message that says what to do, and every file in the folder as before."""
    before = snapshot(whole)
    more = ("--resume", "--set", "load.torque_Nm=171")
    done = run_script(BROKEN_RUN, "ok", *arguments(whole, *more), ranks=ranks)
    assert done.returncode == 2
    assert "found those of another one: this one has load.torque_Nm = 171 (kept: 170); resume with" in done.stderr
    assert "--out" in done.stderr
    assert snapshot(whole) == before


def test_overwriting_run_removes_files_of_the_earlier_run_only(
    whole: Path, run_script: RunScript, tmp_path: Path
) -> None:
    """Another scene into a used folder with --overwrite, killed after its second position: only its own results are
    there, files that are not Evolvent's stay, and --resume goes on with it."""
    out = tmp_path / "out"
    shutil.copytree(whole, out)
    (out / "notes.txt").write_text("mine", encoding="utf-8")
    more = ("--set", "load.torque_Nm=100")
    killed = run_script(BROKEN_RUN, "kill-after-5", *arguments(out, *more, "--overwrite"))
    assert killed.returncode == -9
    names = {path.name for path in (out / "results").glob("*.npz")}
    assert names == {"gears.npz", "state.npz", "position_0000.npz", "position_0001.npz"}
    assert not (out / "summary.json").exists()
    assert (out / "notes.txt").read_text(encoding="utf-8") == "mine"
    done = run_script(BROKEN_RUN, "ok", *arguments(out, *more, "--resume"))
    assert done.returncode == 0, done.stderr
    torques = [row["torque_pinion_Nm"] for row in json.loads((out / "summary.json").read_text())["positions"]]
    assert torques == pytest.approx([100.0] * 8)


@pytest.mark.mpi
def test_full_disk_leaves_a_run_that_resumes(whole: Path, run_script: RunScript, tmp_path: Path) -> None:
    """No space for the fourth file, on two ranks: status 1 and the reason, no half-written file, the positions before
    it intact, and once there is room --resume on one rank completes the run."""
    out = tmp_path / "out"
    done = run_script(BROKEN_RUN, "full-4", *arguments(out), ranks=2)
    assert done.returncode == 1
    wanted = r"position_0001\.npz: wanted to write \S+ MB, found No space left on device; make room"
    assert re.search(wanted, done.stderr)
    assert "--resume" in done.stderr
    assert not list(out.rglob("*.evolvent-part*"))
    assert read_arrays(out / "results" / "state.npz")["complete"] == 1
    assert run_script(BROKEN_RUN, "ok", *arguments(out, "--resume")).returncode == 0
    assert_same(out, whole)


@pytest.mark.skipif(os.geteuid() != 0, reason="mounting a small file system wants root")
def test_full_file_system_ends_with_status_1(run_script: RunScript, tmp_path: Path) -> None:
    """On a file system of 64 kB: status 1 and the reason."""
    small = tmp_path / "small"
    small.mkdir()
    if os.system(f"mount -t tmpfs -o size=64k tmpfs {small} 2>/dev/null") != 0:
        pytest.skip("mounting is not allowed here")
    try:
        done = run_script(BROKEN_RUN, "ok", *arguments(small / "out"))
        assert done.returncode == 1
        assert "No space left on device" in done.stderr
        assert "Traceback" not in done.stderr
        assert not list(small.rglob("*.evolvent-part*"))
    finally:
        os.system(f"umount {small}")


@pytest.mark.parametrize("ranks", on_ranks(1, 2))
def test_impossible_output_folder_ends_with_status_2(ranks: int, run_script: RunScript, tmp_path: Path) -> None:
    """A file where a folder is wanted: status 2 and the reason, on any number of ranks."""
    (tmp_path / "file").write_text("", encoding="utf-8")
    done = run_script(BROKEN_RUN, "ok", *arguments(tmp_path / "file" / "out"), ranks=ranks)
    assert done.returncode == 2
    assert "(Not a directory); allowed: a directory that can be made and written to" in done.stderr


def test_fingerprint_depends_on_results_only() -> None:
    """Whatever changes the results changes it; the title and the output do not."""
    scene = spur_scene()
    assert fingerprint(scene) == fingerprint(spur_scene("title='other'", "output.fields=true"))
    others = ["load.torque_Nm=171", "mesh.level=fine", "sweep.positions=7", "pinion.bore_diameter_mm=71"]
    assert len({fingerprint(scene), *(fingerprint(spur_scene(other)) for other in others)}) == 5


def test_truncated_archive_is_refused(tmp_path: Path) -> None:
    """ArchiveError with the file's name, for every truncation of an archive and for rubbish."""
    path = tmp_path / "state.npz"
    write_bytes(path, arrays_bytes({"a/b": np.arange(5), "text": "x"}))
    assert read_arrays(path)["a/b"].tolist() == [0, 1, 2, 3, 4]
    content = path.read_bytes()
    for size in range(0, len(content), 7):
        path.write_bytes(content[:size])
        with pytest.raises(ArchiveError, match=r"state\.npz: wanted a results file"):
            read_arrays(path)


def test_results_on_other_meshes_are_refused(whole: Path) -> None:
    """Results on meshes that differ from the present ones by 1e-6 mm are not gone on with."""
    scene = spur_scene()
    archive = Archive(whole, scene)
    pinion, wheel = archive.read_gears()
    archive.check_gears((pinion, wheel))
    pinion.points[3] += 1e-6
    with pytest.raises(ArchiveError, match="on others, made by another version"):
        archive.check_gears((pinion, wheel))


def test_results_of_another_version_are_refused(whole: Path, tmp_path: Path) -> None:
    """A position that lacks a field which this version keeps: ArchiveError, what lacks and what to do."""
    out = tmp_path / "run"
    shutil.copytree(whole, out)
    path = out / "results" / "position_0001.npz"
    arrays = read_arrays(path)
    earlier = {name: array for name, array in arrays.items() if not name.endswith("contact/sliding")}
    write_bytes(path, arrays_bytes(earlier))
    scene = load_scene(out / "scene.toml")
    with pytest.raises(ArchiveError, match="found some without 'contact/sliding'; compute anew"):
        Archive(out, scene).read_positions(scene.gear_pair())
