"""`evolvent transient` from rest, on He's pair in plane strain; and what it says of scenes that it cannot take."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest

from evolvent.run.dynamics.transient.summary_lines import summary_lines
from evolvent.run.kinds.transient import Transient
from evolvent.scene.scene import Scene, SceneError, load_scene
from evolvent_meshes.errors import InputError
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.computing.redrawn import redrawn

POSITIONS = 12
SETTINGS = (
    "mesh.level=quick", f"sweep.positions={POSITIONS}", "transient.speeds_rpm=[60]", "transient.mesh_periods=2",
    "transient.tolerance=0.01", "transient.modes_per_harmonic=0", "dynamics.backlash_um=300", "output.animation=false",
)
PLAIN = "output.error_bars=false", "output.pictures=false"
WHOLE = "import sys; from evolvent.commands.app import main; sys.exit(main(sys.argv[1:]))"


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022.toml", [*SETTINGS, "contact.friction=0.0", *settings])


def rows(path: Path) -> list[dict[str, float]]:
    with open(path, encoding="utf-8") as stream:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("rest")
    quietly(Transient.of(scene('transient.start="rest"')), folder)
    return folder


def test_plot_draws_the_start_again(out: Path, tmp_path: Path) -> None:
    """From the tables alone, byte by byte."""
    assert redrawn(out, tmp_path) == {"transient.png", "transient_start.png"}


def test_table_has_two_mesh_periods(out: Path) -> None:
    """Every position since the flanks touched, with statics and error bars."""
    found, numbers = rows(out / "transient_start.csv"), np.arange(1, 2 * POSITIONS + 1)
    assert [row["time_s"] for row in found] == pytest.approx(60.0 / (60.0 * 50.0) / POSITIONS * numbers)
    assert [row["pinion_angle_deg"] for row in found] == pytest.approx(7.2 / POSITIONS * numbers)
    errors = [row["static_transmission_error_um"] for row in found]
    assert errors[:POSITIONS] == errors[POSITIONS:]
    assert all(np.isfinite(row["mesh_force_N_error"]) for row in found)
    assert (out / "pictures/transient_start.png").stat().st_size > 10_000


def test_second_period_is_that_of_the_other_table(out: Path) -> None:
    """transient.csv has the second mesh period, from rotation 0 on: the same numbers, one position later."""
    begun, last = rows(out / "transient_start.csv")[POSITIONS:-1], rows(out / "transient.csv")[1:]
    for name in ("transmission_error_um", "mesh_force_N", "max_pressure_MPa"):
        assert [row[name] for row in begun] == pytest.approx([row[name] for row in last], rel=1e-6, nan_ok=True)


def test_largest_force_is_said(out: Path) -> None:
    """transient.json and the printed line have the largest force over the load, of all time steps."""
    (fact,), (line,) = json.loads((out / "transient.json").read_text()), summary_lines(out)
    largest = max(row["mesh_force_N"] / row["load_N"] for row in rows(out / "transient_start.csv"))
    assert max(largest, 2.0) <= fact["start_dynamic_factor"] * (1.0 + 1e-9)
    assert f"from rest up to a mesh force over load of {fact['start_dynamic_factor']:.2f}" in line
    assert fact["start_dynamic_factor_error"] > 0.0


def test_kept_cases_have_the_start(out: Path, tmp_path: Path) -> None:
    """With --resume from ended cases: the same table."""
    again = copytree(out, tmp_path / "again")
    (again / "transient.csv").unlink()
    quietly(Transient.of(scene('transient.start="rest"', "output.pictures=false")), again, resume=True)
    assert (again / "transient_start.csv").read_text() == (out / "transient_start.csv").read_text()


@pytest.mark.evidence
def test_from_statics_there_is_no_such_table(tmp_path: Path) -> None:
    """Nor a line of it, nor one that an earlier call has left."""
    quietly(Transient.of(scene('transient.start="rest"', *PLAIN)), tmp_path / "x")
    assert (tmp_path / "x/transient_start.csv").exists()
    stiff = scene("dynamics.series_stiffness_N_per_um=700", *PLAIN)
    said = quietly(Transient.of(stiff), tmp_path / "x", overwrite=True)
    assert not (tmp_path / "x/transient_start.csv").exists()
    assert "from rest" not in "".join(summary_lines(tmp_path / "x"))
    assert any(line.startswith("dynamics.series_stiffness_N_per_um: not in a transient") for line in said)


def test_an_inertia_below_the_body_is_refused(tmp_path: Path) -> None:
    """The meshed body of He's pinion has 7.4e-3 kg m², and natural modes that move all of its mass."""
    light = scene("dynamics.pinion_inertia_kg_m2=3e-3", "transient.modes_per_harmonic=1")
    with pytest.raises(InputError, match=r"pinion_inertia_kg_m2: wanted at least that of the gear's body, 0\.0073"):
        quietly(Transient.of(light), tmp_path / "x")


def test_a_wheel_that_drives_is_refused(tmp_path: Path) -> None:
    """Before anything is written, with what computes it."""
    with pytest.raises(SceneError, match=r'load\.driving: found "wheel"; allowed: "pinion" for evolvent transient'):
        quietly(Transient.of(scene("load.driving=wheel")), tmp_path / "x")
    assert not (tmp_path / "x").exists()
