"""`evolvent plot` of a folder of `evolvent transient`: its picture, from the tables that are kept."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.commands.app import main
from evolvent.dynamics.results.transient.beginning import StartRow, write_start
from evolvent.dynamics.results.transient.facts import write_facts
from evolvent.dynamics.results.transient.kept_tables import SCENE, KeptTables
from evolvent.dynamics.results.transient.rows import write_rows
from evolvent.results.archive.run_folder import RunFolder
from tests.support.running.transient_tables import transient_tables


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """A folder as the command leaves it, without the picture."""
    folder, tables = RunFolder(tmp_path), transient_tables((1500.0, 3000.0), (0.0, 0.1))
    folder.write_text(SCENE, f'title = "{tables.title}"\n')
    write_rows(folder, tables.rows, tables.teeth)
    write_facts(folder, tables.facts)
    return tmp_path


def test_tables_are_read_as_they_were_written(out: Path) -> None:
    """Each value to nine digits, what is not known as NaN, truth values and whole numbers as such."""
    wanted, found = transient_tables((1500.0, 3000.0), (0.0, 0.1)), KeptTables.read(out)
    assert found.title == wanted.title
    assert [vars(row) for row in found.rows] == [pytest.approx(vars(row), rel=1e-8) for row in wanted.rows]
    assert [vars(row) for row in found.teeth] == [pytest.approx(vars(row), rel=1e-8, abs=1e-8) for row in wanted.teeth]
    assert [vars(row) for row in found.facts] == [pytest.approx(vars(row), nan_ok=True) for row in wanted.facts]


def test_picture_is_drawn_again(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """And nothing else is touched."""
    before = {path: path.read_bytes() for path in out.iterdir() if path.suffix in (".csv", ".toml")}
    assert main(["plot", str(out)]) == 0
    assert (out / "pictures/transient.png").stat().st_size > 10_000
    assert "1 pictures in" in capsys.readouterr().out
    assert {path: path.read_bytes() for path in before} == before


def test_start_from_rest_is_drawn_again(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Where its table is there; each value is read to nine digits."""
    wanted = [StartRow(1500.0, μ, time, 1.0, 2.0, 0.1, 1.0, 3.0, 0.1, 1.0, 500.0, 5.0, 400.0)
              for μ in (0.0, 0.1) for time in (1e-4, 2e-4)]
    write_start(RunFolder(out), wanted)
    assert KeptTables.read(out).started == wanted
    assert main(["plot", str(out)]) == 0
    assert (out / "pictures/transient_start.png").stat().st_size > 10_000
    assert "2 pictures in" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["transient.csv", "transient_teeth.csv", "transient.json"])
def test_a_table_that_was_cut_off_is_named(out: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    """Half of it is left: the file and the remedy."""
    text = (out / name).read_text()
    (out / name).write_text(text[: len(text) // 2 - 7])
    assert main(["plot", str(out)]) != 0
    assert name in (said := capsys.readouterr().err) and "--overwrite" in said
    assert not (out / "pictures/transient.png").exists()
