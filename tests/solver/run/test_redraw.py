"""`evolvent plot` of tables that no computation has made; that it draws pictures as a command did is tested beside each
command (`tests.support.running.redrawn`)."""

from __future__ import annotations

import re
from importlib import import_module
from inspect import signature
from pathlib import Path

import pytest

from evolvent.commands.app import main
from evolvent.dynamics.figures.all import TRANSIENT_SCENE
from evolvent.dynamics.results.transient.beginning import TRANSIENT_START, StartRow
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS
from evolvent.dynamics.results.transient.rows import TRANSIENT, TRANSIENT_TEETH
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.run.redraw import FROM_TABLES, plot_folder
from tests.support.made_rows import made
from tests.support.running.transient_tables import transient_tables


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """A folder as `evolvent transient` leaves it, without the picture."""
    folder, tables = RunFolder(tmp_path), transient_tables((1500.0, 3000.0), (0.0, 0.1))
    folder.write_text(TRANSIENT_SCENE.name, 'title = "a pair"\n')
    TRANSIENT.write(folder, tables.rows)
    TRANSIENT_TEETH.write(folder, tables.teeth)
    TRANSIENT_FACTS.write(folder, tables.facts)
    return tmp_path


def test_picture_is_drawn_again(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """And nothing else is touched."""
    before = {path: path.read_bytes() for path in out.iterdir() if path.suffix in (".csv", ".toml")}
    assert main(["plot", str(out)]) == 0
    assert (out / "pictures/transient.png").stat().st_size > 10_000
    assert "1 pictures in" in capsys.readouterr().out
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


@pytest.mark.parametrize(("name", "remedy"), [
    ("study.json", "`evolvent study STUDY.toml --out {out}` draws its pictures again"),
    ("load_100.0_percent/scene.toml", "run `evolvent loads SCENE.toml --out {out} --resume` first"),
    ("fatigue_life.csv", "run `evolvent fatigue SCENE.toml --out {out} --overwrite` first"),
    ("strength.toml", "run `evolvent strength SCENE.toml --out {out} --overwrite` first"),
    ("results/transient_static.npz", "run `evolvent transient SCENE.toml --out {out} --resume` first"),
    ("dynamics.json", "run `evolvent dynamics SCENE.toml --out {out} --resume` first"),
    ("results/excitation.npz", "run `evolvent excitation SCENE.toml --out {out} --resume` or `evolvent dynamics"),
    ("results/state.npz", "run `evolvent run SCENE.toml --out {out} --resume` first"),
    ("notes.txt", "run `evolvent run SCENE.toml --out {out}` first"),
])
def test_unfinished_command_is_named(tmp_path: Path, name: str, remedy: str) -> None:
    """A folder with one file of a command, not with all tables of a picture: the command that goes on in it."""
    (tmp_path / name).parent.mkdir(exist_ok=True)
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
