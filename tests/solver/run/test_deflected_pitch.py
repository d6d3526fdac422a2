"""A pitch whose energy balances on deflected flanks only, in the commands that solve it beside `run`.

Problem: a helical steel pair whose teeth bend by a tenth of a module. Before deflection its pitch loses 3e-3 of the
input, on deflected flanks less than 1e-3. The limit of the certificate is set between the two. Exact: the results of
the scene that asks for deflected flanks; so a scene that `run` solves is not refused, nor written as it is.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from evidence.robustness.campaigns.random_scenes import random_scene
from evolvent.gears.solution import certificates
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED
from evolvent.run.dynamics.scene_torques import scene_torques
from evolvent.run.kinds.excitation import Excitation
from evolvent.run.kinds.fatigue import Fatigue
from evolvent.run.kinds.run import Run
from evolvent.run.kinds.strength import Strength
from evolvent.run.kinds.transient import UNLIKE_STATICS, Transient
from evolvent.scene.scene import Scene, load_scene
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.computing.same_tables import same_table

BENT, BETWEEN = 344, 2e-3
ASKED = "exact.parts=deflected-flanks"
TORQUES = 50.0, 100.0
"""Of the excitation, in percent."""
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def bent(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The pair as a scene."""
    path = tmp_path_factory.mktemp("scene") / "bent.toml"
    path.write_text(random_scene(BENT).resolved_toml(), encoding="utf-8")
    return path


@pytest.fixture(autouse=True)
def strict(monkeypatch: pytest.MonkeyPatch) -> None:
    """The limit of the certificate."""
    monkeypatch.setattr(certificates, "BALANCE_LIMIT", BETWEEN)


def scene(path: Path, *settings: str) -> Scene:
    usual = "contact.friction=0.0", "output.error_bars=false", "output.pictures=false", "output.animation=false"
    return load_scene(path, [*usual, "sweep.positions=6", *settings])


def same(first: Path, second: Path, *tables: str) -> None:
    """Both folders have the same tables, and scenes byte by byte."""
    for name in tables:
        one, other = first / name, second / name
        alike = same_table(one, other) if one.suffix != ".toml" else one.read_bytes() == other.read_bytes()
        assert alike, name


@pytest.mark.evidence
def test_transient_has_its_statics_on_deflected_flanks(bent: Path, tmp_path: Path) -> None:
    """Statics and motion of 500 r/min, and a sentence on the flanks of both; resumed, the statics are not solved again,
    and the sentence stays."""
    settings = "transient.speeds_rpm=[500]", "transient.mesh_periods=2", "transient.modes_per_harmonic=0"
    found, asked = tmp_path / "found", tmp_path / "asked"
    said = quietly(Transient.of(scene(bent, *settings)), found)
    assert UNLIKE_STATICS in said
    assert UNLIKE_STATICS not in quietly(Transient.of(scene(bent, ASKED, *settings)), asked)
    same(asked, found, "transient.csv", "transient.json", "scene.toml")
    assert UNLIKE_STATICS in quietly(Transient.of(scene(bent, *settings)), found, resume=True)
    same(asked, found, "transient.csv", "transient.json", "scene.toml")


@pytest.mark.evidence
def test_strength_has_its_roots_on_deflected_flanks(bent: Path, tmp_path: Path) -> None:
    """Root stress at uniform and further positions, and the scene that is written."""
    found, asked = tmp_path / "found", tmp_path / "asked"
    assert ON_DEFLECTED in quietly(Strength.of(scene(bent)), found)
    assert ON_DEFLECTED not in quietly(Strength.of(scene(bent, ASKED)), asked)
    same(asked, found, "strength.csv", "root_stress.csv", "scene.toml")


def test_run_says_that_its_flanks_are_deflected(bent: Path, tmp_path: Path) -> None:
    """One sentence, printed, in run.log and in summary.json, and again where the finished run is resumed; the log does
    not say that deflected flanks are skipped. Nothing of it where the scene asks for them; where they are not needed,
    as by a stiff spur pair, they are skipped, and the log says so."""
    found, asked, stiff = (tmp_path / name for name in ("found", "asked", "stiff"))

    def said(folder: Path, *settings: str, resume: bool = False, path: Path = bent) -> tuple[bool, bool, bool]:
        quietly(Run.of(scene(path, *settings)), folder, resume=resume)
        log, summary = ((folder / name).read_text(encoding="utf-8") for name in ("run.log", "summary.json"))
        return ON_DEFLECTED in log, ON_DEFLECTED in json.loads(summary)["warnings"], "skipped, deflected" in log

    assert said(found) == (True, True, False)
    assert said(found, resume=True) == (True, True, False)
    assert said(asked, ASKED) == (False, False, False)
    same(asked, found, "teeth.csv", "scene.toml")
    assert said(stiff, "mesh.level=quick", path=ROOT / "demos/he2022.toml") == (False, False, True)


def test_fatigue_has_its_flanks_deflected(bent: Path, tmp_path: Path) -> None:
    """The flanks' loads, and the scene that is written."""
    found, asked = tmp_path / "found", tmp_path / "asked"
    assert ON_DEFLECTED in quietly(Fatigue.of(scene(bent)), found)
    assert ON_DEFLECTED not in quietly(Fatigue.of(scene(bent, ASKED)), asked)
    same(asked, found, "fatigue.csv", "scene.toml")


@pytest.mark.evidence
def test_excitation_is_that_of_deflected_flanks(bent: Path, tmp_path: Path) -> None:
    """Curves under two torques, and a sentence; resumed, nothing is solved again, and the sentence stays."""
    found, asked = tmp_path / "found", tmp_path / "asked"
    own, other = (scene_torques(scene(bent, "sweep.positions=12", *more), TORQUES) for more in ((), (ASKED,)))
    said = quietly(Excitation.under(own), found)
    assert ON_DEFLECTED in said and ON_DEFLECTED not in quietly(Excitation.under(other), asked)
    same(asked, found, "excitation.csv", "harmonics.csv")
    prepare: Any = None  # nothing calls it
    assert quietly(Excitation.under(own), found, resume=True, prepare=prepare) == said
    same(asked, found, "excitation.csv", "harmonics.csv")
