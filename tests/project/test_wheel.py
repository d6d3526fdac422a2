"""The built wheel, installed into a fresh environment and used outside the checkout."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

from tests.support.checkout import ROOT

SOURCES = ("pyproject.toml", "README.md", "LICENSE", "solver", "meshes")
TINY = (
    "--level", "quick", "--quiet", "--set", "sweep.positions=4", "--set", "output.pictures=false",
    "--set", "output.animation=false", "--set", "output.fields=false", "--set", "output.error_bars=false",
)
HEAVY = {"numpy", "scipy", "dolfinx", "petsc4py", "mpi4py", "matplotlib", "pyvista", "gmsh", "pydantic"}


def called(*command: str | Path, cwd: Path) -> subprocess.CompletedProcess[str]:
    """A finished command in a folder outside the checkout; an error where it failed."""
    inherited = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    words = [str(word) for word in command]
    done = subprocess.run(
        words, cwd=cwd, env={**inherited, "OMP_NUM_THREADS": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"},
        capture_output=True, text=True, timeout=300, check=False,
    )
    assert done.returncode == 0, f"{words}: {done.stdout}{done.stderr}"
    return done


@pytest.fixture(scope="module")
def python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The interpreter of a new environment with the wheel; what Debian has not got comes from this environment."""
    folder = tmp_path_factory.mktemp("wheel")
    source, fresh = folder / "source", folder / "environment"
    source.mkdir()
    for name in SOURCES:  # setuptools leaves its folders beside what it builds
        leave = shutil.ignore_patterns("__pycache__", "*.egg-info")
        path = ROOT / name
        shutil.copytree(path, source / name, ignore=leave) if path.is_dir() else shutil.copy(path, source / name)
    pip = (sys.executable, "-m", "pip", "--quiet")
    called(*pip, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, source, cwd=folder)
    venv.create(fresh, system_site_packages=True)
    (wheel,) = folder.glob("evolvent-*.whl")
    called(*pip, "--python", fresh / "bin/python", "install", "--no-deps", "--no-index", wheel, cwd=folder)
    # a line of a path file is a folder whose own path files are not read: the checkout's editable install stays unseen
    (packages(fresh) / "ours.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return fresh / "bin/python"


def packages(environment: Path) -> Path:
    """The folder that an environment's own packages are in."""
    (folder,) = environment.glob("lib/python3*/site-packages")
    return folder


def test_the_wheel_brings_two_packages(python: Path) -> None:
    """evolvent and evolvent_meshes and what pip keeps of them: no other package, none named solver, meshes or wear."""
    brought = {path.name for path in packages(python.parents[1]).iterdir()} - {"ours.pth", "__pycache__"}
    (record,) = (name for name in brought if name.endswith(".dist-info"))
    assert brought - {record} == {"evolvent", "evolvent_meshes"}
    assert record.startswith("evolvent-")


def test_importing_the_package_loads_nothing_heavy(python: Path, tmp_path: Path) -> None:
    """`import evolvent` is the wheel's, and leaves the numerical libraries to whoever asks for a name of theirs."""
    code = "import json, sys, evolvent; print(json.dumps([evolvent.__file__, *sys.modules]))"
    where, *loaded = json.loads(called(python, "-c", code, cwd=tmp_path).stdout)
    assert Path(where).is_relative_to(python.parents[1])
    assert HEAVY & set(loaded) == set()


def test_the_wheel_runs_a_scene(python: Path, tmp_path: Path) -> None:
    """`evolvent run` of a copied scene at one position: status 0, a summary with the scene's torque."""
    shutil.copy(ROOT / "demos/he2022.toml", tmp_path / "pair.toml")
    called(python.parent / "evolvent", "run", "pair.toml", "--out", "out", *TINY, cwd=tmp_path)
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert summary["scene"]["load"]["torque_Nm"] > 0.0
    code = "from evolvent.fem.body import Body; print(Body.__module__)"
    assert called(python, "-c", code, cwd=tmp_path).stdout == "evolvent.fem.body\n"
