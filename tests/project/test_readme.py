"""README.md's lines for several ranks, as they are typed in a fresh shell.

Problem: a shell with PATH and HOME alone, whoever the user is, on any number of cores. Exact: status 0, a line of the
version from the first rank alone.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from evolvent import __version__
from tests.support.checkout import ROOT


def test_mpirun_as_it_is_typed(tmp_path: Path) -> None:
    """The block with the exports, each `evolvent run ...` in it replaced by `evolvent --version`."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    block = next(part for part in re.findall(r"^```sh\n(.*?)^```", text, re.DOTALL | re.MULTILINE) if "mpirun" in part)
    lines = [re.sub(r"evolvent run .*", "evolvent --version", line.strip()) for line in block.splitlines()]
    assert sum(line.startswith("mpirun") for line in lines) == 2 and "evolvent run" not in " ".join(lines)
    paths = [str(Path(sys.executable).parent), "/usr/local/bin", "/usr/bin", "/bin"]
    clean = {"PATH": os.pathsep.join(paths), "HOME": str(tmp_path)}
    done = subprocess.run(
        ["sh", "-e", "-c", "\n".join(lines)], env=clean, cwd=ROOT, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [f"evolvent {__version__}"] * 2
