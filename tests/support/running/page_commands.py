"""What stands in the pages' shell lines, done in seconds: page_commands.py NAME [ARGUMENT ...] is run as NAME.

The commands of `evolvent` that compute run as they are typed, on narrow gears with a coarse mesh or at few positions.
`docker run` runs the program of this checkout with the folders that it mounts; what needs an engine is run by .ci/run.
`make` says what it would do; of a module of the evidence it is looked up that it is there, for it writes into the
checkout, and of a demo, which test_demos.py runs, that it takes the line's words.
"""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path

PLAIN = ("output.error_bars=false", "output.pictures=false", "output.animation=false")
CHEAP = (
    "sweep.positions=4", "contact.friction=[0.1]", "mesh.order=1", "mesh.elements_per_contact_width=0.5",
    "pinion.face_width_mm=2", "wheel.face_width_mm=2", "load.torque_Nm=20", *PLAIN,
)
"""Settings that stand behind those of a line: what it computes takes seconds then."""
FEW = ("sweep.positions=6", *PLAIN)
FEWER = {
    "run": CHEAP, "loads": CHEAP, "losses": FEW, "excitation": FEW, "strength": FEW, "design": FEW,
    "transient": FEW, "fatigue": CHEAP, "study": (*FEW, "mesh.level=quick"),
    "dynamics": (*FEW, "dynamics.speeds=20", "dynamics.torque_percents=[50,100,200]", "dynamics.mesh=\"tangent\""),
}
"""Command -> its settings."""
NAMES = ("docker", "evolvent", "git", "make", "paraview", "python")


def evolvent(words: list[str]) -> None:
    """The command line of this checkout."""
    fewer = FEWER.get("".join(words[:1]), ())
    if fewer == CHEAP and "line" in words:
        fewer = FEW  # line contact has no width to be resolved
    settings = [word for setting in fewer for word in ("--set", setting)]
    os.execv(sys.executable, [sys.executable, "-m", "evolvent", *words, *settings])


def docker(words: list[str]) -> None:
    """`docker build` finds its Dockerfile; `docker run` of the image `evolvent` runs the words after the image."""
    if words[0] == "build":
        require(Path(words[-1], "Dockerfile").is_file(), "a Dockerfile")
        return
    require(words[0] == "run" and "evolvent" in words, "docker run ... evolvent ...")
    image = words.index("evolvent")
    options, command = words[1:image], words[image + 1 :]
    mounts = [options[at + 1].split(":") for at, option in enumerate(options) if option == "-v"]
    for host, inside, *_ in mounts:
        require(Path(host).is_dir(), f"the folder {host}")
        command = [word.replace(f"{inside}/", f"{host}/", 1) if word.startswith(inside) else word for word in command]
    if command[0] == "mpirun":
        os.execvp("mpirun", command)
    evolvent(command)


def git(words: list[str]) -> None:
    """`git clone ADDRESS FOLDER`: a folder with what is here, so that nothing is written into the checkout."""
    require(words[0] == "clone" and len(words) == 3, "git clone ADDRESS FOLDER")
    here = list(Path.cwd().iterdir())
    Path(words[2]).mkdir()
    for path in here:
        Path(words[2], path.name).symlink_to(path)


def make(words: list[str]) -> None:
    """What would be done for a target that there is."""
    os.execv("/usr/bin/make", ["make", "-n", "-C", os.environ["CHECKOUT"], *words])


def paraview(words: list[str]) -> None:
    """A file that is there."""
    require(Path(words[0]).is_file(), f"the file {words[0]}")


def python(words: list[str]) -> None:
    """`python -m evidence.MODULE`: a module that can be run; its files are there, but for what it makes (`--out`).
    `python demos/NAME.py`: it takes these words."""
    if words[0].startswith("demos/"):
        os.execv(sys.executable, [sys.executable, *words, "--help"])
    require(words[0] == "-m" and words[1].startswith("evidence."), "python -m evidence.MODULE")
    spec = find_spec(words[1])
    require(spec is not None and spec.origin is not None, f"the module {words[1]}")
    assert spec is not None and spec.origin is not None
    runs = Path(spec.origin).with_name("__main__.py") if spec.submodule_search_locations else Path(spec.origin)
    require(runs.is_file() and "__main__" in runs.read_text(encoding="utf-8"), f"a main program in {words[1]}")
    for before, word in pairwise(words[1:]):
        made = before == "--out"
        require(made or word.startswith("-") or "/" not in word or Path(word).exists(), word)


def require(holds: bool, wanted: str) -> None:
    """Ends with status 1 where what a line needs is not there."""
    if not holds:
        sys.exit(f"{' '.join(sys.argv[1:])}: wanted {wanted}")


if __name__ == "__main__":
    {each.__name__: each for each in (docker, evolvent, git, make, paraview, python)}[sys.argv[1]](sys.argv[2:])
