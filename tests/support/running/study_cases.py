"""Studies of Zhang's pair that take no time to compute, to be read, changed or broken by tests."""

from __future__ import annotations

from pathlib import Path

from evidence.tables import read_csv
from evolvent.run.study.plan.study_file import load_study
from evolvent.run.study.plan.study_scenes import StudyScene, study_scenes
from evolvent.run.study.results.figures import gathered_figures
from evolvent.run.study.study_run import Study
from tests.support.checkout import ROOT

HEAD = f"""
title = "a study"
scene = "{ROOT / "demos/zhang2023.toml"}"
compute = "check"
"""
TORQUES = f"{HEAD}[grid]\nload.torque_Nm = [100.0, 200.0, 300.0]\n"
"""Three scenes that are checked."""
VERSION = "1.0"


def written(folder: Path, text: str = TORQUES) -> Path:
    """The path of a study file with this text."""
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return path


def scenes_of(folder: Path, text: str, version: str = VERSION) -> list[StudyScene]:
    """The scenes of a study with this text."""
    path = written(folder, text)
    return study_scenes(load_study(path), path, (), version)


def study_of(folder: Path, text: str = TORQUES) -> Study:
    """A study with this text, ready to be computed."""
    file = load_study(written(folder, text))
    return Study(file, scenes_of(folder, text), gathered_figures(file, "study.toml"))


def table(out: Path) -> list[dict[str, str]]:
    """Rows of a study's table."""
    return read_csv(out / "study.csv")
