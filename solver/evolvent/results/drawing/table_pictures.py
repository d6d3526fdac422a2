"""Pictures that are drawn from the tables of a folder alone, so that `evolvent plot` draws them again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from evolvent.results.drawing.picture_files import Picture


class Readable(Protocol):
    """A table, or another file that a picture is drawn from."""

    @property
    def name(self) -> str:
        """Name of the file."""

    def read(self, folder: Path) -> Any:
        """Content of the file in a folder. Raises ArchiveError."""


@dataclass(frozen=True)
class TablePicture:
    """A picture, and the tables that it is drawn from."""

    name: str
    """Name of the file in OUT/pictures."""
    needs: tuple[Readable, ...]
    """Tables that it is drawn from; a folder without one of them has no such picture."""
    draw: str
    """"module:function" that takes the contents of the tables and returns a figure. Imported when it is drawn, as
    matplotlib takes a second to import."""

    def is_of(self, folder: Path) -> bool:
        """Whether the folder has all tables that the picture is drawn from."""
        return all((folder / table.name).is_file() for table in self.needs)

    def drawn(self, folder: Path) -> bytes:
        """Content of the picture's file. Raises ArchiveError."""
        from evolvent.results.drawing.style import png_of

        module, _, function = self.draw.partition(":")
        return png_of(getattr(import_module(module), function), *(table.read(folder) for table in self.needs))


def from_tables(pictures: Iterable[TablePicture], folder: Path) -> Iterator[Picture]:
    """The pictures whose tables are in the folder."""
    for each in pictures:
        if each.is_of(folder):
            yield Picture(each.name, partial(each.drawn, folder))
