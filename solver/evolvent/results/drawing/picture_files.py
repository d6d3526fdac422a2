"""Pictures drawn one by one: a failure affects neither the other pictures nor the run's results."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from evolvent.results.archive.archive import ArchiveError
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent_meshes.files import WriteError


@dataclass(frozen=True)
class Picture:
    """A picture that is not drawn yet."""

    name: str
    """Name of the file in OUT/pictures."""
    draw: Callable[[], bytes]
    """Function that draws the picture and returns the content of the file."""


@dataclass(frozen=True)
class Drawn:
    """Outcome of drawing pictures."""

    written: tuple[Path, ...]
    """Paths of the files written."""
    failures: tuple[str, ...]
    """A sentence for each picture that could not be drawn."""


def draw(pictures: Iterable[Picture], folder: RunFolder) -> Drawn:
    """Draws pictures into OUT/pictures. Raises WriteError where a file cannot be written, as the next could not be
    either, and ArchiveError where a table that a picture is drawn from cannot be read."""
    written, failures = [], []
    for picture in pictures:
        try:
            written.append(folder.write(f"pictures/{picture.name}", picture.draw()))
        except WriteError:
            raise
        except ArchiveError:  # a table, whose remedy is not to draw again
            raise
        except FolderError as error:  # a foreign file of this name, whose remedy is not to draw again
            failures.append(f"picture {picture.name}: not drawn ({error})")
        except Exception as error:  # whatever matplotlib, pyvista or a graphics driver may raise
            reason = str(error) or type(error).__name__
            failures.append(f"picture {picture.name}: not drawn ({reason}); `evolvent plot` draws it again")
    return Drawn(tuple(written), tuple(failures))
