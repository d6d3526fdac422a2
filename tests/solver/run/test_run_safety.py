"""What a run does to a folder in which something lies already: nothing is lost unasked, nothing foreign is touched."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from evolvent.commands.app import main
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.results.drawing.style import png, sheet, styled
from evolvent_meshes.files import WriteError
from evolvent_meshes.mesh.mesh_data import MeshError
from tests.support.run_parts import hashes
from tests.support.running.processes import RunScript

SETTINGS = (
    "sweep.positions=3", "output.pictures=false", "output.animation=false", "output.error_bars=false",
    "output.fields=true",
)


def run(out: Path, *more: str, scene: str | Path = "demos/he2022.toml") -> int:
    """`evolvent run` of He's spur pair in this process."""
    settings = [word for setting in SETTINGS for word in ("--set", setting)]
    return main(["run", str(scene), "--out", str(out), "--level", "quick", "--quiet", *settings, *more])


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a finished run with fields, of six positions."""
    out = tmp_path_factory.mktemp("finished") / "out"
    assert run(out, "--set", "sweep.positions=6") == 0
    return out


@pytest.fixture
def out(finished: Path, tmp_path: Path) -> Path:
    """A copy of it, with foreign files in the same folders."""
    copy = tmp_path / "out"
    shutil.copytree(finished, copy)
    for name in THEIRS:
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_text(f"their {name}", encoding="utf-8")
    return copy


THEIRS = ("photo.png", "pictures/photo.png", "pictures/02_mine.png", "results/measured.npz", "fields/contact.csv",
          "worn_1000/pictures/photo.png", "notes/a.txt")


def theirs(out: Path) -> dict[str, str]:
    found = hashes(out)
    return {name: found[name] for name in THEIRS}


def test_finished_run_is_not_lost_unasked(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without --resume and --overwrite: status 2, both named, every file as before."""
    before = hashes(out)
    assert run(out) == 2
    message = capsys.readouterr().err
    assert "--resume" in message and "--overwrite" in message
    assert hashes(out) == before


def test_overwriting_removes_files_of_runs_only(out: Path) -> None:
    """--overwrite: foreign files stay, byte by byte, and are named in the log; fields of the positions that the
    longer run had are gone."""
    before = theirs(out)
    assert (out / "fields/flanks_0005.vtp").exists() and (out / "fields/gears_0005.vtp").exists()
    assert run(out, "--overwrite") == 0
    assert theirs(out) == before
    assert sorted(path.name for path in (out / "fields").glob("*.vtp")) == [
        f"{part}_{k:04d}.vtp" for part in ("flanks", "gears") for k in range(3)
    ]
    assert len(json.loads((out / "summary.json").read_text(encoding="utf-8"))["positions"]) == 3
    log = (out / "run.log").read_text(encoding="utf-8")
    assert "left alone, as no run has written them: photo.png" in log
    assert "pictures/02_mine.png" in log and "results/measured.npz" in log


def test_foreign_results_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder with results/state.npz of another program: status 2, it is named, nothing is changed."""
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "state.npz").write_text("of another program", encoding="utf-8")
    before = hashes(tmp_path)
    for more in ((), ("--resume",), ("--overwrite",)):
        assert run(tmp_path, *more) == 2
        assert "results/state.npz" in capsys.readouterr().err
    assert hashes(tmp_path) == before


def test_the_folder_of_a_study_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of all commands that compute a scene: status 2 with what to do, nothing is written."""
    (tmp_path / "study.json").write_text("{}")
    for command in ("run", "loads", "excitation"):
        assert main([command, "demos/he2022.toml", "--out", str(tmp_path), "--overwrite"]) == 2
        assert "found a study (study.json); allowed: a folder without" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["study.json"]


def test_scene_is_not_written_over_its_source(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`run own/scene.toml --out own`: status 2, own/scene.toml as it was, comments and all; also with --overwrite."""
    path = tmp_path / "scene.toml"
    path.write_text(Path("demos/he2022.toml").read_text(encoding="utf-8") + "# mine\n", encoding="utf-8")
    before = hashes(tmp_path)
    for more in ((), ("--overwrite",), ("--resume",)):
        assert run(tmp_path, *more, scene=path) == 2
        assert "own file" in capsys.readouterr().err
    assert hashes(tmp_path) == before


def test_scene_of_a_run_can_be_run_where_it_lies(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """OUT/scene.toml, which a run has written: resumed as it is; with another torque it would be written over, which is
    refused."""
    scene = out / "scene.toml"
    before = scene.read_bytes()
    same = ["run", str(scene), "--out", str(out), "--quiet"]
    assert main([*same, "--resume"]) == 0
    assert main([*same, "--overwrite"]) == 0
    assert main([*same, "--overwrite", "--set", "load.torque_Nm=100"]) == 2
    assert "over which a run writes" in capsys.readouterr().err
    assert scene.read_bytes() == before


def test_changed_results_are_not_written_over(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A table that was edited: status 2 with its name, before anything is removed."""
    with open(out / "positions.csv", "a", encoding="utf-8") as file:
        file.write("my remark\n")
    before = hashes(out)
    assert run(out, "--overwrite") == 2
    assert "positions.csv" in capsys.readouterr().err
    assert hashes(out) == before


def test_resuming_without_results_is_a_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """--resume where no run has been, as after one that was stopped while meshing: it begins, and says so; not of a
    run that is there."""
    said = f"--resume found nothing to continue in {tmp_path / 'new'} (no results/state.npz)"
    assert run(tmp_path / "new", "--resume") == 0
    assert capsys.readouterr().err.count(said) == 1
    assert said in (tmp_path / "new/run.log").read_text(encoding="utf-8")
    assert run(tmp_path / "new", "--resume") == 0
    assert "found nothing to continue" not in capsys.readouterr().err


CUT = {"results/state.npz": "--overwrite", "results/position_0002.npz": "--overwrite", "summary.json": "--resume"}
"""What can be cut off, and the option that `plot` says to run again with."""


@pytest.mark.parametrize("name", CUT)
def test_truncated_file_is_named_with_its_remedy(
    name: str, out: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every command names the file and says to move or remove it; what `plot` says is done, and works."""
    monkeypatch.setattr("evolvent.results.figures.all.pictures", lambda run: [])
    path = out / name
    path.write_bytes(path.read_bytes()[:100])
    for more in ("--resume", "--overwrite"):
        assert run(out, more) == 2
        assert f"move or remove {path}, or" in capsys.readouterr().err
    assert main(["plot", str(out)]) == (2 if name.endswith(".npz") else 0)
    said = capsys.readouterr().err
    assert str(path) in said and "move or remove" in said and CUT[name] in said
    path.unlink()
    longer = ("--set", "sweep.positions=6")
    assert run(out, CUT[name], *(longer if CUT[name] == "--resume" else ())) == 0
    json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert main(["plot", str(out)]) == 0
    assert "changed" not in capsys.readouterr().err


def test_second_run_into_a_folder_is_refused(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The second one, and a `plot`: status 2, who is at it, nothing touched."""
    before = hashes(out)
    with locked(out):
        lock = hashes(out).keys() - before.keys()
        assert run(out, "--overwrite") == 2
        assert "computes into, found process" in capsys.readouterr().err
        assert main(["plot", str(out)]) == 2
    assert lock == {".evolvent.lock"}
    assert hashes(out) == before


def test_mesh_error_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Input that only meshing finds bad: no run.log, no folder."""
    def fails(*_: object) -> None:
        raise MeshError("wanted a sector that can be meshed, found one that cannot")

    monkeypatch.setattr("evolvent.gears.meshing.levelled_meshes.gear_mesh", fails)
    assert run(tmp_path / "out") == 2
    assert "a sector that can be meshed" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_failing_picture_is_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Status 0, the tables complete, the other pictures drawn; which one is missing, why and what to do is said on
    stderr and in the log."""
    def fails() -> bytes:
        raise ArithmeticError("no such colour")

    both = [Picture("a.png", fails), Picture("b.png", lambda: b"b")]
    monkeypatch.setattr("evolvent.results.figures.all.pictures", lambda run: both)
    assert run(tmp_path, "--set", "output.pictures=true") == 0
    wanted = "picture a.png: not drawn (no such colour); `evolvent plot` draws it again"
    assert wanted in capsys.readouterr().err
    assert wanted in (tmp_path / "run.log").read_text(encoding="utf-8")
    assert (tmp_path / "summary.json").exists()
    assert [path.name for path in (tmp_path / "pictures").iterdir()] == ["b.png"]


def test_tables_come_before_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that ends while it draws leaves complete tables."""
    def drawn() -> bytes:
        assert (tmp_path / "summary.json").exists() and (tmp_path / "positions.csv").exists()
        raise KeyboardInterrupt

    monkeypatch.setattr("evolvent.results.figures.all.pictures", lambda run: [Picture("a.png", drawn)])
    assert run(tmp_path, "--set", "output.pictures=true") == 1
    assert (tmp_path / "summary.json").exists()


@pytest.mark.parametrize("title", ["pair $ alpha_{ $", r"\frac{1", "$x^$", "50 % {load}"])
def test_titles_are_drawn_as_they_are(title: str) -> None:
    """Dollar signs and braces in a title are its own."""
    with styled():
        assert png(sheet(title, "what to see")).startswith(b"\x89PNG")


def test_no_room_for_pictures_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """WriteError at the first one, instead of a warning each."""
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("evolvent_meshes.files.os.fsync", full)
    with pytest.raises(WriteError, match="make room"):
        draw([Picture("a.png", lambda: b"a")], RunFolder(tmp_path))


@pytest.mark.parametrize("place", ["file/a.msh", "/dev/null/a.msh", "/proc/a.msh", "x" * 300 + ".msh"])
def test_mesh_to_an_impossible_path_is_refused(place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Status 2 before anything is meshed, and nothing is made."""
    (tmp_path / "file").write_text("", encoding="utf-8")
    assert main(["mesh", "demos/he2022.toml", "--out", str(tmp_path / place)]) == 2
    assert "can be made and written to" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("kind", ["file", "folder", "link"])
def test_mesh_does_not_replace_an_existing_file(
    kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`mesh --out` onto what exists: status 2 and --overwrite named; a folder not even with it."""
    path = tmp_path / "pair.msh"
    make: dict[str, Callable[[], object]] = {
        "file": lambda: path.write_text("mine", encoding="utf-8"), "folder": path.mkdir,
        "link": lambda: path.symlink_to(tmp_path / "nowhere"),
    }
    make[kind]()
    command = ["mesh", "demos/he2022.toml", "--level", "quick", "--out", str(path)]
    assert main(command) == 2
    assert "--overwrite" in capsys.readouterr().err or kind == "folder"
    assert main([*command, "--overwrite"]) == (2 if kind == "folder" else 0)
    assert path.is_dir() if kind == "folder" else path.read_bytes().startswith(b"$MeshFormat")


ALONE = """
import sys
from mpi4py import MPI
from evolvent.commands.app import main
if MPI.COMM_WORLD.rank == 0:
    from evolvent.run.kinds.run import Run
    from evolvent.results.drawing.picture_files import Picture
    Run.pictures = lambda run, out: [Picture("01_a.png", lambda: b"a")]
scene, out, folder = sys.argv[1:]
statuses = [main(["--version"]), main(["check", scene]), main(["plot", folder]), main(["plot", folder + "/nowhere"])]
statuses.append(main(["mesh", scene, "--level", "quick", "--out", out]))
if MPI.COMM_WORLD.rank == 0:
    print([int(status) for status in statuses])
"""


@pytest.mark.mpi
def test_serial_commands_under_mpirun_run_once(out: Path, run_script: RunScript, tmp_path: Path) -> None:
    """On two ranks: each is done once, by rank 0, and ends; each says what it says once."""
    done = run_script("-c", ALONE, "demos/he2022.toml", str(tmp_path / "a.msh"), str(out), ranks=2, timeout=100.0)
    assert done.returncode == 0, done.stderr
    counts = [done.stdout.count(text) for text in ("evolvent 0.", "1 picture in", "Hertz", "a.msh: ")]
    assert counts[:2] == [1, 1] and all(counts) and "[0, 0, 0, 2, 0]" in done.stdout
    assert done.stderr.count("found no such directory") == 1
    assert (out / "pictures/01_a.png").read_bytes() == b"a"
