"""`evolvent excitation` at mesh.level = "line": resumed, on two ranks; commands and keys that refuse the level."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from evolvent.gears.line.line_gears import LineGears, LinePosition
from evolvent.run.dynamics.excitation_lines import excitation_lines
from evolvent.run.kinds.all import KINDS
from evolvent.run.kinds.excitation import Excitation
from evolvent.scene.scene import SceneError
from tests.support.computing.interruption import Interrupted, interrupted
from tests.support.computing.quiet import quietly
from tests.support.computing.same_tables import same_tables
from tests.support.computing.small_kinds import small
from tests.support.gear_cases import spur_scene
from tests.support.running.processes import RunScript

RELIEVED = tuple(
    f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("tip_relief_um=20", 'tip_relief_form="parabolic"')
)
LINE = (*RELIEVED, "mesh.level=line", "sweep.positions=4", "output.error_bars=true")
PERCENTS = [50.0, 100.0]
SERVED = {"run", "loads", "losses", "excitation", "dynamics", "design"}


def excitation(*settings: str) -> Excitation:
    """Excitation of He's relieved pair under half and all of its torque."""
    return Excitation.of(spur_scene(*LINE, *settings), PERCENTS)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("line")
    quietly(excitation(), folder)
    return folder


def test_interrupted_excitation_solves_nothing_again(
    whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Interrupted as three results are stored, resumed: each of 4 positions of the meshes and of their companion is
    made once in all; the same tables."""
    made: list[float] = []

    def counted(_: LineGears, angle: float) -> LinePosition:
        made.append(angle)
        return position(_, angle)

    position = LineGears.position
    monkeypatch.setattr(LineGears, "position", counted)
    with interrupted(3), pytest.raises(Interrupted):
        quietly(excitation(), tmp_path)
    assert len(made) == 3
    quietly(excitation(), tmp_path, resume=True)
    assert len(made) == 8
    assert same_tables(tmp_path, whole)


@pytest.mark.mpi
def test_results_do_not_depend_on_ranks(whole: Path, tmp_path: Path, run_script: RunScript) -> None:
    """The tables of one rank and of two."""
    done = run_script(__file__, str(tmp_path / "ranks"), ranks=2, timeout=300.0)
    assert done.returncode == 0, done.stderr[-3000:]
    assert same_tables(tmp_path / "ranks", whole)


def test_facts_have_the_figures_of_a_line_contact(whole: Path, tmp_path: Path) -> None:
    """p_0 has an error; K_Hβ is null in the plane. Where the contact is resolved both are null."""
    facts = json.loads((whole / "excitation.json").read_text(encoding="utf-8"))
    assert facts["mesh_level"] == "line" and facts["face_load_factor"] is None
    assert 500.0 < facts["largest_pressure_MPa"] < 2000.0
    assert 0.0 < facts["largest_pressure_MPa_error"] < 0.1 * facts["largest_pressure_MPa"]
    assert list(excitation_lines(whole))[-1].startswith("100 %, 170 N·m, line contact: p_0 ")
    quietly(excitation("mesh.level=quick", "output.error_bars=false"), tmp_path)
    facts = json.loads((tmp_path / "excitation.json").read_text(encoding="utf-8"))
    assert facts["face_load_factor"] is facts["largest_pressure_MPa"] is None


def test_torques_that_edges_bear_are_left_out(tmp_path: Path) -> None:
    """Problem: reliefs that serve half of the torque. Under the scene's whole torque edges bear: a warning, and no rows
    of it; an error where the scene's own torque is the one."""
    scene = spur_scene(
        "pinion.tip_relief_um=6", "wheel.tip_relief_um=6", "mesh.level=line", "sweep.positions=8", "load.torque_Nm=60"
    )
    warnings = quietly(Excitation.of(scene, [100.0, 400.0]), tmp_path)
    assert any("have no figures" in sentence for sentence in warnings)
    facts = json.loads((tmp_path / "excitation.json").read_text(encoding="utf-8"))
    assert facts["torques_Nm"] == [60.0]


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.name not in SERVED], ids=lambda kind: kind.name)
def test_commands_that_resolve_the_contact_refuse_it(kind, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    """Status 2 before anything is written, with the commands that serve."""
    with pytest.raises(SceneError, match="line serves evolvent run, loads, losses, excitation, dynamics and design"):
        quietly(small(kind, "mesh.level=line"), tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("setting", [
    "mesh.order=1", 'mesh.shape="tetrahedron"', "mesh.elements_per_contact_width=3", 'exact.parts=["one-sector"]',
])
def test_keys_of_a_resolved_contact_are_refused(setting: str) -> None:
    """Each names its key and a remedy."""
    with pytest.raises(SceneError, match=setting.partition("=")[0]):
        spur_scene("mesh.level=line", setting)


if __name__ == "__main__":
    quietly(excitation(), Path(sys.argv[1]))
