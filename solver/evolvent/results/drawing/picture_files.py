"""Pictures are drawn one by one: one that cannot be drawn costs neither the others nor the run's results."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from evolvent.results.archive.run_folder import RunFolder
from evolvent_meshes.files import WriteError


@dataclass(frozen=True)
class Picture:
    """A picture of a run that is still to be drawn.

    name: of its file in OUT/pictures.
    draw: makes the file's content.
    """

    name: str
    draw: Callable[[], bytes]


@dataclass(frozen=True)
class Drawn:
    """What came of some pictures.

    written: their files.
    failures: a sentence for each that could not be drawn.
    """

    written: tuple[Path, ...]
    failures: tuple[str, ...]


def draw(pictures: Iterable[Picture], folder: RunFolder) -> Drawn:
    """Draws into OUT/pictures. Raises WriteError where there is no room for one: the next would have none either."""
    written, failures = [], []
    for picture in pictures:
        try:
            written.append(folder.write(f"pictures/{picture.name}", picture.draw()))
        except WriteError:
            raise
        except Exception as error:  # whatever matplotlib, pyvista or a graphics driver may raise
            reason = str(error) or type(error).__name__
            failures.append(f"picture {picture.name}: not drawn ({reason}); `evolvent plot` draws it again")
    return Drawn(tuple(written), tuple(failures))
