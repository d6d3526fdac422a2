"""Values that no parameter of their kind may have, and files that no command may read."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterator, Mapping

from evolvent.run.study.plan.study_file import StudyFile
from evolvent.scene.scene import Scene
from evolvent.scene.schema.errors import keys_of

NO_FILE = ("", "no\0name", "n" * 5000, "absent", "folder", "pipe", "/dev/null", "/dev/zero", "scene.toml/below",
           "dangling", "loop")
"""Names of what is no file to read."""
NO_FOLDER = ("", "no\0name", "n" * 5000, "scene.toml", "scene.toml/below", "pipe", "/dev/null", "/proc/evolvent",
             "loop", "loop/below", "/dev/null/below")
"""Names of what is no folder that may be written, nor can be made."""
NO_NUMBER = ("", "many", "0", "-1", "nan", "inf", "1e300", "0x10", "5 N", "1,5", "--", "٣٫٣")
"""Texts that are no force, diameter or the like."""
NO_VALUE = ("1979-05-27", "{a = 1}", "nan", "-inf", "[[1]]", "[{}]", "1" * 500, "0x1p3", "1_", "'a")
"""Values that no key of a scene and of a study takes."""
WRONG: Mapping[str, tuple[str, ...]] = {
    "SCENE.toml": NO_FILE,
    "STUDY.toml": NO_FILE,
    "RECORD.csv...": (*NO_FILE, "scene.toml"),
    "DIR": (*NO_FOLDER, "absent", "folder", "dangling"),
    "--out DIR": NO_FOLDER,
    "--out FILE.png": ("", "teeth", "teeth.svg", "scene.toml/teeth.png", "no\0name.png"),
    "--out FILE.msh": ("", "pair", "pair.stl", "scene.toml/pair.msh", "no\0name.msh"),
    "--level line|quick|standard|fine": ("", "Quick", "quick ", "ultra", "1", 'fine"', "[]", "\udcff"),
    "--set KEY=VALUE": ("", "=", "load.torque_Nm", "load.torque_Nm=", "=100", "load=100", "load.torque_Nm=1 2",
                        "a.b.c=1", "load..torque_Nm=1", "[load]=1", "load.torque_Nm=100\n[x]", "#=1", "\udcff=1"),
    "--exact NAME": ("", "windows", "all", "Window", "window,plane", "\udcff"),
    "--percent LIST": ("", ",", "50,", "0", "-50", "50,50", "nan", "1e9", "fifty", "50;100", "50%",
                       ",".join(map(str, range(1, 1001)))),
    "--cache-size GB": ("", "-1", "nan", "inf", "1e9", "20 GB", "many"),
    "list|clear": ("", "List", "lists", "clear all", "\udcff"),
    "--workers N": ("", "0", "-1", "two", "1.5", "1e3", "nan", "1" * 400),
    "--scheduler ADDRESS": ("", "nowhere", "http://127.0.0.1:1", "tcp://", "tcp://127.0.0.1", "tcp://127.0.0.1:0x1",
                            "tcp://127.0.0.1:99999999", "tls://127.0.0.1:1", "ucx://127.0.0.1:1", "tcp://[::1",
                            "\udcff"),
    "--petsc-options OPTIONS": (),  # PETSc takes every text, and warns of options that it does not know
    "--force-N": NO_NUMBER,
    "--pin-diameter-mm": NO_NUMBER,
    "--run-in-m": tuple(text for text in NO_NUMBER if text != "0"),
}
"""Kind of a parameter -> values that are refused."""
SPOILT: Mapping[str, Callable[[bytes], bytes]] = {
    "no content": lambda text: b"",
    "blanks": lambda text: b" \n\t\n" * 99,
    "zeros": lambda text: bytes(999),
    "UTF-16": lambda text: text.decode().encode("utf-16"),
    "a Latin-1 letter": lambda text: b'x = "gr\xf6\xdfe"\n' + text,
    "a zero within": lambda text: text[:40] + b"\0" + text[40:],
    "one section twice": lambda text: text + text[text.index(b"\n[") :],
    "an open text": lambda text: text + b'\n[open]\nx = "\n',
    "an open list": lambda text: text + b"\nx = [1, 2",
    "an open section": lambda text: text + b"\n[x",
    "deep lists": lambda text: b"x = " + b"[" * 50_000 + b"]" * 50_000 + b"\n" + text,
    "deep keys": lambda text: b".".join([b"a"] * 20_000) + b" = 1\n" + text,
    "a long line": lambda text: b"x" * 1_000_000 + b" = 1\n" + text,
    "a million lines": lambda text: b"x = 1\n" * 1_000_000,
    "JSON": lambda text: b'{"pair": {"normal_module_mm": 3}}',
    "XML": lambda text: b'<?xml version="1.0"?><pair/>',
    "a table": lambda text: b"a;b\n1;2\n",
    "a picture": lambda text: b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 9,
    "sections as lists": lambda text: re.sub(rb"^\[(.*)\]", rb"[[\1]]", text, flags=re.MULTILINE),
    "values without keys": lambda text: re.sub(rb"^\w+ =", b"=", text, flags=re.MULTILINE),
    "keys without values": lambda text: re.sub(rb"= .*", b"=", text),
    "colons": lambda text: text.replace(b" = ", b": "),
    "decimal commas": lambda text: re.sub(rb"(\d)\.(\d)", rb"\1,\2", text),
    "typographic minus": lambda text: re.sub(rb"= (\d)", "= \N{MINUS SIGN}\\1".encode(), text),
    "bare fractions": lambda text: re.sub(rb"= (\d)", rb"= .\1", text),
}
"""What is wrong with a scene or study file -> how it comes of a sound one."""


def spoilt_at_random(text: bytes, seed: int) -> bytes:
    """The text with a piece cut out and a closing bracket that nothing has opened, at places that the seed says."""
    chance = random.Random(seed)
    begin = chance.randrange(len(text))
    kept = text[:begin] + text[begin + chance.randrange(1, 30) :]
    place = chance.randrange(len(kept) + 1)
    return kept[:place] + b"\n]\n" + kept[place:]


def scene_settings() -> Iterator[str]:
    """For every key of a scene, `KEY=VALUE` with each value that it cannot have."""
    yield from (f"{name}={value}" for name in keys_of(Scene) for value in NO_VALUE)


def study_lines() -> Iterator[str]:
    """For every key of a study outside its sections, a line with each value that it cannot have."""
    yield from (f"{name} = {value}\n" for name in StudyFile.model_fields for value in NO_VALUE)
