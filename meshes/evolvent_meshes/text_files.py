"""Text files of users, with a clear message where they are not UTF-8."""

from __future__ import annotations

import codecs
from pathlib import Path

from evolvent_meshes.errors import InputError
from evolvent_meshes.files import NoFile, open_file

MEGABYTE = 1_000_000
SAVE = "save the file as UTF-8 (plain ASCII is UTF-8 too)"


class UnreadableText(InputError):
    """A file that cannot be used as text.

    found, allowed, remedy: what was found, what is allowed and what to do, phrases without a full stop.
    """

    def __init__(self, found: str, allowed: str, remedy: str) -> None:
        super().__init__(f"found {found}; allowed: {allowed}; remedy: {remedy}")
        self.found, self.allowed, self.remedy = found, allowed, remedy


def read_text(path: Path, kind: str, megabytes: int) -> str:
    """The text of a file without its byte order mark.

    kind: format for messages, such as "TOML". megabytes: largest size that is read. Raises UnreadableText.
    """
    wanted = f"a readable {kind} file"
    try:
        with open_file(path) as file:
            content = file.read(megabytes * MEGABYTE + 1)
    except NoFile as error:
        raise UnreadableText(str(error.strerror), wanted, "write what it gives to a file, and name that one") from error
    except (OSError, ValueError) as error:  # ValueError: the path has a NUL
        found = error.strerror if isinstance(error, OSError) else "a path with a NUL character"
        raise UnreadableText(str(found), wanted, f"check the path {str(path)!r}") from error
    if len(content) > megabytes * MEGABYTE:
        remedy = f"is this the right file? {path}"
        raise UnreadableText(f"more than {megabytes} MB", f"{wanted} of up to {megabytes} MB", remedy)
    return _decoded(content, f"{wanted}, in UTF-8")


def _decoded(content: bytes, allowed: str) -> str:
    """The text of UTF-8 bytes. Raises UnreadableText."""
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        raise UnreadableText("text in UTF-16", allowed, SAVE)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        found = f"bytes that are no UTF-8 text, the first 0x{content[error.start]:02x} in line {line}"
        raise UnreadableText(found, allowed, f"{SAVE}; it may be Latin-1 or Windows-1252") from error
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise UnreadableText(f"a NUL character in line {line}: UTF-16, or no text at all", allowed, SAVE)
    return text
