"""`evolvent run`, `loads` and `losses` at mesh.level = "line": tables beside the resolved ones, resuming, ranks; what a
line contact has not is refused or not given."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import pytest

from evolvent.gears.line.line_gears import LineGears, LinePosition
from evolvent.gears.line.line_result import EdgeContact
from evolvent.run.kinds.all import KINDS
from evolvent.run.kinds.loads import Loads
from evolvent.run.kinds.losses import LOSSES, Losses
from evolvent.run.kinds.run import Run
from evolvent.scene.scene import Scene, SceneError, scene_from_text
from tests.support.computing.interruption import Interrupted, interrupted
from tests.support.computing.quiet import quietly
from tests.support.computing.redrawn import redrawn
from tests.support.computing.same_tables import same_tables
from tests.support.computing.small_kinds import small
from tests.support.gear_cases import HELICAL, QUIET, spur_scene
from tests.support.running.processes import RunScript

RELIEVED = tuple(
    f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("tip_relief_um=20", 'tip_relief_form="parabolic"')
)
LINE = (*RELIEVED, "mesh.level=line", "sweep.positions=4", "contact.friction=[0.0,0.1]")
BARS = "output.error_bars=true"
LINEAR = tuple(f'{gear}.tip_relief_form="linear"' for gear in ("pinion", "wheel"))


def line_scene(*settings: str) -> Scene:
    """He's relieved pair in line contact."""
    return spur_scene(*LINE, *settings)


def helical_line(*settings: str) -> Scene:
    """A relieved narrow helical pair in line contact."""
    text = HELICAL.replace('level = "quick"\norder = 1\nelements_per_contact_width = 0.5', 'level = "line"')
    return scene_from_text(text, [*QUIET, *(setting.replace("=20", "=60") for setting in RELIEVED), *settings])


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("line")
    quietly(Run.of(line_scene(BARS)), folder)
    return folder


def frictions(folder: Path) -> list[dict[str, float]]:
    """Values of the pitch at each friction coefficient."""
    found: list[dict[str, float]] = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["frictions"]
    return found


def test_run_is_within_its_error_bars_of_the_resolved_one(whole: Path, tmp_path: Path) -> None:
    """Problem: He's relieved pair at μ = 0 and 0.1. Reference: the same positions resolved at level fine. Every figure
    is within the sum of both error bars, stiffnesses within 0.5 %, loss and shaft forces within 1 %."""
    quietly(Run.of(spur_scene(*LINE[:-3], BARS, *LINE[-2:], "mesh.level=fine")), tmp_path)
    for line, fine in zip(frictions(whole), frictions(tmp_path), strict=True):
        for name, bar in fine["estimated_error"].items():  # type: ignore[attr-defined]
            own = line["estimated_error"][name]  # type: ignore[index]
            assert line[name] == pytest.approx(fine[name], abs=bar + own + 1e-12), name
        for name in ("mesh_stiffness_N_per_mm_um", "secant_stiffness_N_per_mm_um"):
            assert line[name] == pytest.approx(fine[name], rel=5e-3)
        assert line["loss_percent"] == pytest.approx(fine["loss_percent"], rel=1e-2)
        for gear in ("forces_on_pinion", "forces_on_wheel"):
            for name in ("tangential_N", "radial_N"):
                assert line[gear][name] == pytest.approx(fine[gear][name], rel=1e-2)  # type: ignore[index]
        assert line["balance_error"] < 1e-9
    method = json.loads((whole / "summary.json").read_text(encoding="utf-8"))["estimated_error"]["method"]
    assert "what line contact is off by" in method


def test_interrupted_run_solves_nothing_again(whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupted in the middle and resumed: each of the 4 positions of the meshes and of their companion is made once
    in all; the same tables."""
    made: list[float] = []
    position = LineGears.position

    def counted(gears: LineGears, angle: float) -> LinePosition:
        made.append(angle)
        return position(gears, angle)

    monkeypatch.setattr(LineGears, "position", counted)
    with interrupted(6), pytest.raises(Interrupted):
        quietly(Run.of(line_scene(BARS)), tmp_path)
    assert 0 < len(made) < 8
    quietly(Run.of(line_scene(BARS)), tmp_path, resume=True)
    assert len(made) <= 9  # one may have been made, but not stored
    assert same_tables(tmp_path, whole)


@pytest.mark.mpi
def test_results_do_not_depend_on_ranks(whole: Path, tmp_path: Path, run_script: RunScript) -> None:
    """The tables of one rank and of two."""
    done = run_script(__file__, str(tmp_path / "ranks"), ranks=2, timeout=300.0)
    assert done.returncode == 0, done.stderr[-3000:]
    assert same_tables(tmp_path / "ranks", whole)


@pytest.mark.slow
def test_pressures_that_are_none_of_a_line_contact_are_not_given(tmp_path: Path) -> None:
    """Problem: linear reliefs, whose start some contacts cover. There kink_pressure_MPa is nan, and 0 elsewhere; no
    file of fields, no animation, no picture of the flank or of Hertz' formula, and cells across the contact are null.
    """
    asked = "output.pictures=true", "output.animation=true", "output.fields=true", "sweep.positions=20"
    warnings = quietly(Run.of(line_scene(*LINEAR, *asked)), tmp_path)
    with open(tmp_path / "teeth.csv", encoding="utf-8") as stream:
        cells = {row["kink_pressure_MPa"] for row in csv.DictReader(stream)}
    assert cells == {"0", "nan"}
    mesh = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))["mesh"]
    assert mesh["cells_across_contact_width"] is mesh["cells_across_narrow_contact"] is None
    assert not any("elements wide" in sentence for sentence in warnings)
    pictures = {path.name for path in (tmp_path / "pictures").iterdir()}
    assert "08_load_sharing.png" in pictures
    assert not pictures & {"01_loaded_pair.png", "02_flank_pressure.png", "10_hertz.png", "animation.gif"}
    assert not (tmp_path / "fields").exists()
    assert redrawn(tmp_path, tmp_path.parent / f"{tmp_path.name}_again") == pictures


@pytest.mark.slow
def test_helical_run_has_its_load_over_the_face(tmp_path: Path) -> None:
    """Problem: a narrow helical pair with 10 µm of misalignment. K_Hβ is above 1, the axial force that of the helix,
    F_t tan β within 1 %, and loss is in proportion to μ within 5 %."""
    scene = helical_line("contact.friction=[0.05,0.1]", "load.torque_Nm=40", "pair.misalignment_um=10")
    quietly(Run.of(scene), tmp_path)
    low, high = frictions(tmp_path)
    assert 1.01 < low["face_load_factor"] < 3.0
    forces = low["forces_on_pinion"]
    assert forces["axial_N"] == pytest.approx(0.3640 * forces["tangential_N"], rel=2e-2)  # type: ignore[index]
    assert high["loss_percent"] == pytest.approx(2.0 * low["loss_percent"], rel=5e-2)


def test_losses_and_loads_are_those_of_runs(whole: Path, tmp_path: Path) -> None:
    """Exact: losses.csv and loads.csv have the loss of a run under the same torque."""
    quietly(Losses.of(line_scene(), [50.0, 100.0]), tmp_path / "losses")
    heaviest = [row for row in LOSSES.read(tmp_path / "losses") if row.torque_Nm == 170.0]
    quietly(Loads.of(line_scene(), [50.0, 100.0]), tmp_path / "loads")
    with open(tmp_path / "loads" / "loads.csv", encoding="utf-8") as stream:
        listed = [row for row in csv.DictReader(stream) if float(row["torque_Nm"]) == 170.0]
    for run, row, load in zip(frictions(whole), heaviest, listed, strict=True):
        assert row.loss_percent == pytest.approx(run["loss_percent"], rel=1e-8)
        assert float(load["loss_percent"]) == pytest.approx(run["loss_percent"], rel=1e-8)


@pytest.mark.parametrize("kind", [Run, Losses])
def test_edges_that_bear_are_an_error(kind: type[Run] | type[Losses], tmp_path: Path) -> None:
    """Problem: the pair without relief, at 20 positions. No table is written."""
    scene = spur_scene("mesh.level=line", "contact.friction=0.1", "sweep.positions=20")
    with pytest.raises(EdgeContact, match="tip_relief_um"):
        quietly(kind.of(scene, [100.0]), tmp_path)
    assert not list(tmp_path.glob("*.csv"))


@pytest.mark.parametrize("setting", ["output.deformation=true", "dynamics.operating_rpm=2000"])
@pytest.mark.parametrize("kind", [Run, Loads])
def test_what_a_line_contact_has_not_is_refused(kind: type[Run] | type[Loads], setting: str, tmp_path: Path) -> None:
    """Status 2 before anything is written, by the name of the key."""
    more = ("dynamics.backlash_um=50",) if setting.startswith("dynamics") else ()
    with pytest.raises(SceneError, match=setting.partition("=")[0]):
        quietly(kind.of(line_scene(setting, *more), [100.0]), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_wear_is_refused(tmp_path: Path) -> None:
    """Status 2: wear needs the pressure across the contact."""
    (wear,) = (kind for kind in KINDS if kind.name == "wear")
    with pytest.raises(SceneError, match=r"mesh\.level.*wear"):
        quietly(small(wear, "mesh.level=line"), tmp_path / "out")


if __name__ == "__main__":
    quietly(Run.of(line_scene(BARS)), Path(sys.argv[1]))
