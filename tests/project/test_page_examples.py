"""Every code block and every shell line of the pages runs, as it stands there.

Exact: status 0. A page's blocks are run in order, in a folder that has what a checkout has; those of Python continue
each other. Shell lines run by page_commands.py, in seconds.
"""

from __future__ import annotations

import os
import re
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from evolvent.scene.scene import scene_from_text
from tests.support.checkout import PYTHONPATH, ROOT
from tests.support.running.page_commands import NAMES
from tests.support.running.processes import one_at_a_time
from tests.support.running.samples import sampled

PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])
LANGUAGES = {"sh", "python", "toml", "text", "yaml"}
SHARED = ("demos", "docs", "Dockerfile")
COMMANDS = "|".join([*NAMES, "export", "mkdir", "mpirun"])


def blocks(page: Path, language: str) -> list[str]:
    """The page's fenced blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


def having(language: str) -> list[Path]:
    """The pages that have blocks of a language."""
    return [page for page in PAGES if blocks(page, language)]


TUTORIAL_FIRST = sampled(sorted(having("sh"), key=lambda page: page.name != "tutorial.md"))
API_FIRST = sampled(sorted(having("python"), key=lambda page: page.name != "gears_api.md"))


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A folder to type the lines in: demos and pages of the checkout, two scenes of one's own, the commands."""
    for name in SHARED:
        (tmp_path / name).symlink_to(ROOT / name)
    for name in ("scene.toml", "mine.toml"):
        (tmp_path / name).write_bytes((ROOT / "demos/he2022.toml").read_bytes())
    commands = tmp_path / ".venv/bin"
    commands.mkdir(parents=True)
    (commands / "activate").touch()
    for name in NAMES:
        program = commands / name
        script = ROOT / "tests/support/running/page_commands.py"
        program.write_text(f'#!/bin/sh\nexec {sys.executable} {script} {name} "$@"\n')
        program.chmod(program.stat().st_mode | stat.S_IEXEC)
    return tmp_path


def environment(checkout: Path) -> dict[str, str]:
    """A fresh shell's, with the commands first, and what MPI asks of root."""
    return {
        "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "PATH": os.pathsep.join([str(checkout / ".venv/bin"), "/usr/local/bin", "/usr/bin", "/bin"]),
        "HOME": str(checkout), "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache")),
        "PYTHONPATH": PYTHONPATH, "CHECKOUT": str(ROOT), "OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg",
    }


@pytest.mark.mpi
@pytest.mark.slow
@pytest.mark.parametrize("page", TUTORIAL_FIRST, ids=lambda page: page.name)
def test_shell_lines_run(page: Path, checkout: Path) -> None:
    """All shell blocks of a page, one after the other in one shell that stops at the first failure."""
    script = "set -e\n" + "".join(blocks(page, "sh"))
    with one_at_a_time(2 if "mpirun" in script else 1):
        done = subprocess.run(
            ["sh", "-c", script], cwd=checkout, env=environment(checkout), capture_output=True, text=True,
            timeout=600, check=False,
        )
    assert done.returncode == 0, f"{page.name}: {done.stdout[-2000:]}{done.stderr[-2000:]}"


@pytest.mark.parametrize("page", API_FIRST, ids=lambda page: page.name)
def test_python_blocks_run(page: Path, checkout: Path) -> None:
    """All Python blocks of a page, one after the other in one program."""
    program = "\n".join(blocks(page, "python"))
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=checkout, env=environment(checkout), capture_output=True, text=True,
        timeout=600, check=False,
    )
    assert done.returncode == 0, f"{page.name}: {done.stderr[-2000:]}"


@pytest.mark.parametrize("page", having("toml"), ids=lambda page: page.name)
def test_scenes_are_scenes(page: Path) -> None:
    """Each TOML block of a page is a scene without an error, and says the same as it is written back with defaults."""
    for text in blocks(page, "toml"):
        scene = scene_from_text(text)
        assert scene_from_text(scene.resolved_toml()) == scene


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_blocks_name_their_language(page: Path) -> None:
    """Every fence says what it holds, and no shell line hides in an indented block, which nothing runs."""
    text = page.read_text(encoding="utf-8")
    fences = re.findall(r"^```(.*)$", text, re.MULTILINE)
    assert set(fences[::2]) <= LANGUAGES and set(fences[1::2]) <= {""}
    outside = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    assert re.findall(rf"^ {{4}}(?:{COMMANDS}) .*$", outside, re.MULTILINE) == []


def test_a_line_that_fails_is_noticed(checkout: Path) -> None:
    """A key that no scene has, an unknown target and a file that is not there: the shell stops with a message."""
    for line in ("evolvent check scene.toml --set load.torque=1", "make no-such-target", "paraview none.pvd"):
        command = ["sh", "-c", line]
        done = subprocess.run(command, cwd=checkout, env=environment(checkout), capture_output=True, check=False)
        assert done.returncode != 0 and done.stderr
