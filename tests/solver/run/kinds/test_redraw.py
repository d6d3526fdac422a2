"""`evolvent plot` of tables that no computation has made; that it draws pictures as a command did is tested beside each
command (`tests.support.computing.redrawn`)."""

from __future__ import annotations

import re
from importlib import import_module
from inspect import signature
from pathlib import Path

import pytest

from evolvent.commands.app import main
from evolvent.dynamics.results.transient.beginning import TRANSIENT_START, StartRow
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS
from evolvent.dynamics.results.transient.rows import TRANSIENT, TRANSIENT_TEETH
from evolvent.results.archive.run_cost import Cost, write_cost
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.archive.scene_files import write_scene
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.run.call import DEFAULT
from evolvent.run.folder_checks import check_folder
from evolvent.run.kinds.all import KINDS, Kind
from evolvent.run.kinds.redraw import plot_folder
from evolvent.scene.scene import load_scene
from tests.support.checkout import ROOT
from tests.support.computing.small_kinds import small
from tests.support.made_rows import made
from tests.support.running.transient_tables import transient_tables
from tests.support.scene_texts import WEAR

FROM_TABLES = sorted(
    {picture for kind in KINDS for picture in kind.load().outputs.pictures}, key=lambda picture: picture.name
)


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """A folder as `evolvent transient` leaves it, without the picture."""
    folder, tables = RunFolder(tmp_path), transient_tables((1500.0, 3000.0), (0.0, 0.1))
    write_scene(load_scene(ROOT / "demos/he2022.toml", ["transient.speeds_rpm=[1500,3000]"]), folder)
    TRANSIENT.write(folder, tables.rows)
    TRANSIENT_TEETH.write(folder, tables.teeth)
    TRANSIENT_FACTS.write(folder, tables.facts)
    return tmp_path


def test_picture_is_drawn_again(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """And nothing else is touched."""
    before = {path: path.read_bytes() for path in out.iterdir() if path.suffix in (".csv", ".toml")}
    assert main(["plot", str(out)]) == 0
    assert (out / "pictures/transient.png").stat().st_size > 10_000
    assert "1 picture in" in capsys.readouterr().out
    assert {path: path.read_bytes() for path in before} == before


def test_start_from_rest_is_drawn_again(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Where its table is there."""
    rows = [
        made(StartRow, speed_rpm=1500.0, friction=μ, time_s=time, mesh_force_N=3.0, load_N=1.0)
        for μ in (0.0, 0.1) for time in (1e-4, 2e-4)
    ]
    TRANSIENT_START.write(RunFolder(out), rows)
    assert main(["plot", str(out)]) == 0
    assert (out / "pictures/transient_start.png").stat().st_size > 10_000
    assert "2 pictures in" in capsys.readouterr().out


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_unfinished_command_is_named(tmp_path: Path, kind: Kind) -> None:
    """A folder in which a command has begun, without its first table: the command that goes on in it."""
    folder, wearing = RunFolder(tmp_path), WEAR if kind.name == "wear" else ()
    write_scene(load_scene(ROOT / "demos/he2022.toml", ["contact.friction=[0.1]", *wearing]), folder)
    write_cost(folder, Cost(command=kind.command))
    remedy = f"run `evolvent {kind.command} SCENE.toml --out {tmp_path} --resume`"
    with pytest.raises(FolderError, match=re.escape(remedy)):
        plot_folder(tmp_path)


def test_folder_of_a_running_call_is_locked(tmp_path: Path) -> None:
    """A command has begun, and still runs: plot says that, not that the command is to be resumed."""
    write_cost(RunFolder(tmp_path), Cost(command="losses"))
    with locked(tmp_path), pytest.raises(FolderError, match="no other run computes into, found process") as refused:
        plot_folder(tmp_path)
    assert "--resume" not in str(refused.value)


def test_folder_of_an_earlier_version_is_named(tmp_path: Path) -> None:
    """Root strength without scene.toml: the command that leaves one."""
    RunFolder(tmp_path).write_text("strength.csv", "results")
    remedy = f"run `evolvent strength SCENE.toml --out {tmp_path} --resume` first"
    with pytest.raises(FolderError, match=rf"without their scene\.toml.*{re.escape(remedy)}"):
        plot_folder(tmp_path)


@pytest.mark.parametrize(("name", "remedy"), [
    ("study.json", "`evolvent study STUDY.toml --out {out}` draws its pictures again"),
    ("notes.txt", "run `evolvent run SCENE.toml --out {out}` first"),
])
def test_folder_without_results_is_refused(tmp_path: Path, name: str, remedy: str) -> None:
    """A folder of a study, or of files that no command has written: what draws its pictures."""
    (tmp_path / name).write_text("begun", encoding="utf-8")
    with pytest.raises(FolderError, match=re.escape(remedy.format(out=tmp_path))):
        plot_folder(tmp_path)


@pytest.mark.parametrize("name", ["transient.csv", "transient_teeth.csv", "transient.json"])
def test_a_table_that_was_cut_off_is_named(out: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    """Half of it is left: the file and the remedy."""
    text = (out / name).read_text()
    (out / name).write_text(text[: len(text) // 2 - 7])
    assert main(["plot", str(out)]) != 0
    assert name in (said := capsys.readouterr().err) and "--overwrite" in said
    assert not (out / "pictures/transient.png").exists()


@pytest.mark.parametrize("picture", FROM_TABLES, ids=lambda picture: picture.name)
def test_every_picture_has_a_function_that_takes_its_tables(picture: TablePicture) -> None:
    """As many parameters as tables: the name is a text, which no type checker reads."""
    module, _, function = picture.draw.partition(":")
    assert len(signature(getattr(import_module(module), function)).parameters) == len(picture.needs)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_foreign_picture_is_not_drawn(kind: Kind, tmp_path: Path) -> None:
    """Files of the names of all pictures that no call has written: nothing is refused, and each picture is left
    undrawn, with what can be done; drawing again would not help."""
    own = [name for name in kind.load().outputs.results if name.startswith("pictures/")]
    names = [Path(name).name for name in own] or ["01_a.png"]
    (tmp_path / "pictures").mkdir()
    for name in names:
        (tmp_path / "pictures" / name).write_text("mine", encoding="utf-8")
    check_folder(small(kind), tmp_path, DEFAULT)
    drawn = draw([Picture(name, lambda: b"ours") for name in names], RunFolder(tmp_path))
    assert len(drawn.failures) == len(names) and not drawn.written
    assert all("move or remove" in said and "evolvent plot" not in said for said in drawn.failures)
    assert {path.read_text(encoding="utf-8") for path in (tmp_path / "pictures").iterdir()} == {"mine"}


def test_an_empty_folder_stays(tmp_path: Path) -> None:
    """Nothing to draw in a folder of the user's: refused, and the folder is still there."""
    folder = tmp_path / "mine"
    folder.mkdir()
    with pytest.raises(FolderError, match="found no results in it"):
        plot_folder(folder)
    assert folder.is_dir() and not list(folder.iterdir())
