"""Each idea has a room of its own, a room imports only from rooms above it, and neither grows too large.

A room is a folder's own files. ROOMS has them from the top down, with what each may import: "fem" is a room, "fem.*"
that room with all rooms below it. Imports inside functions and for type hints count as all others do.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from tests.project.rooms import FLOORS, ROOMS
from tests.support.checkout import ROOT

FILES, BELOW, LINES = 16, 12, 300
"""Of a room at most: its files, the rooms directly below it, the lines of a file."""
PACKAGES = ("solver/evolvent", "meshes/evolvent_meshes")
TREES = ("solver/evolvent", "meshes/evolvent_meshes", "demos", "evidence", "tests")
Imports = Mapping[str, set[str]]


def modules(trees: tuple[str, ...] = PACKAGES) -> dict[str, Path]:
    """Every module of these trees but the doors of rooms (`__init__.py`), which only say what a room has."""
    roots = [(ROOT / tree).parent for tree in trees]
    files = [[path for path in sorted((ROOT / tree).rglob("*.py")) if path.name != "__init__.py"] for tree in trees]
    return {
        ".".join(path.relative_to(root).with_suffix("").parts): path
        for root, paths in zip(roots, files) for path in paths
    }


def imports(trees: tuple[str, ...] = PACKAGES) -> dict[str, set[str]]:
    """Module -> the modules of these trees that it imports."""
    known = modules(trees)
    return {name: set(_targets(ast.parse(path.read_bytes()), known)) - {name} for name, path in known.items()}


def _targets(tree: ast.Module, known: Mapping[str, Path]) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"wanted absolute imports, found {ast.unparse(node)!r}"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            yield from (each for each in (name, name.rpartition(".")[0]) if each in known)


def room(module: str) -> str:
    """The room of ROOMS that a module is in."""
    parent = module.rpartition(".")[0]
    return parent.replace("evolvent_meshes", "meshes").removeprefix("evolvent.")


def allows(entry: str, target: str) -> bool:
    """Whether an entry of ROOMS is for a room."""
    tree = entry.removesuffix(".*")
    return target == tree or (entry != tree and target.startswith(f"{tree}."))


def refused(found: Imports) -> list[str]:
    """The imports that ROOMS does not allow."""
    return sorted(
        f"{module} imports {target}"
        for module, targets in found.items() for target in targets
        if room(target) != room(module) and not any(allows(entry, room(target)) for entry in ROOMS[room(module)])
    )


def test_a_room_imports_from_rooms_above_it() -> None:
    """No import is refused, and every room is in the list."""
    found = imports()
    assert {room(module) for module in found} == set(ROOMS)
    assert refused(found) == []


def test_rooms_do_not_use_the_doors_of_packages() -> None:
    """`evolvent/__init__.py`, `evolvent/gears/__init__.py` and so on list public names of rooms; no room imports from
    them, but for the version that the command line prints."""
    known = modules()
    doors = []
    for module, path in known.items():
        for node in ast.walk(ast.parse(path.read_bytes())):
            if not isinstance(node, ast.ImportFrom) or node.module in known:
                continue
            if str(node.module).startswith("evolvent"):
                doors += [(module, name) for each in node.names if (name := f"{node.module}.{each.name}") not in known]
    assert doors == [("evolvent.commands.options", "evolvent.__version__")]


def test_the_list_of_rooms_has_no_arrow_up() -> None:
    """A room may import only what stands before it in the list."""
    names = list(ROOMS)
    backwards = [(name, target) for at, name in enumerate(names) for entry in ROOMS[name]
                 for target in names[at:] if allows(entry, target)]
    assert backwards == []


def upward(found: Imports) -> list[str]:
    """The imports that lead to a higher floor."""
    floors = {name: floor for floor, names in enumerate(FLOORS) for name in names}

    def floor_of(module: str) -> int:
        return floors[room(module).split(".")[0]]

    return sorted(f"{module} imports {target}" for module, targets in found.items() for target in targets
                  if floor_of(target) > floor_of(module))


def test_a_room_imports_from_its_own_floor_and_lower_ones() -> None:
    """No import leads up, and the list of rooms has the floors in their order. Right: one that leads up is found."""
    found = imports()
    assert upward(found) == []
    assert list(dict.fromkeys(name.split(".")[0] for name in ROOMS)) == [name for floor in FLOORS for name in floor]
    wrong = {"evolvent.scene.scene": {"evolvent.dynamics.of_scene"}}
    assert upward(found | wrong) == ["evolvent.scene.scene imports evolvent.dynamics.of_scene"]


def test_the_list_of_rooms_allows_no_more_than_is_used() -> None:
    """Every entry of the list stands for an import that there is."""
    used = {(room(module), room(target)) for module, targets in imports().items() for target in targets}
    spare = [(name, entry) for name, entries in ROOMS.items() for entry in entries
             if not any(one == name and allows(entry, other) for one, other in used)]
    assert spare == []


def test_no_two_files_need_each_other() -> None:
    """The imports between files have no circle: all of them can be put into an order."""
    assert set(TopologicalSorter(imports()).static_order()) == set(modules())


def test_the_rule_can_be_broken() -> None:
    """An import against the list and a circle of two files are found."""
    found = imports() | {"evolvent.fem.surface": {"evolvent.contact.search.pairing"}}
    assert refused(found) == ["evolvent.fem.surface imports evolvent.contact.search.pairing"]
    with pytest.raises(CycleError):
        TopologicalSorter(found).prepare()


def evidence_room(module: str) -> str:
    """The folder of a module of evidence. A command (`__main__`) is a room of its own above those that it starts."""
    return module if module.endswith(".__main__") else module.rpartition(".")[0]


def between_rooms(found: Imports) -> dict[str, set[str]]:
    """Room of evidence -> the rooms that it imports."""
    rooms: dict[str, set[str]] = {evidence_room(module): set() for module in found}
    for module, targets in found.items():
        rooms[evidence_room(module)] |= {evidence_room(target) for target in targets}
    return {name: targets - {name} for name, targets in rooms.items()}


def test_evidence_has_no_circle() -> None:
    """Evidence may import all of the packages and demos; its own files, and its own rooms, have no circle."""
    found = imports(("evidence",))
    assert len(found) > 60
    TopologicalSorter(found).prepare()
    TopologicalSorter(between_rooms(found)).prepare()


def test_a_circle_of_rooms_can_be_seen() -> None:
    """Two files of one room that import, and are imported by, another room: no circle of files, but one of rooms."""
    found = {"evidence.a.one": {"evidence.b.two"}, "evidence.b.two": {"evidence.a.three"}, "evidence.a.three": set()}
    TopologicalSorter(found).prepare()
    with pytest.raises(CycleError):
        TopologicalSorter(between_rooms(found)).prepare()


def test_packages_import_nothing_that_stands_on_them() -> None:
    """Neither evidence nor demos nor tests."""
    above = imports((*PACKAGES, "evidence", "demos", "tests"))
    outside = [f"{module} imports {target}" for module in modules() for target in above[module]
               if target.split(".")[0] in ("evidence", "demos", "tests")]
    assert outside == []


def sizes(tree: Path) -> list[str]:
    """What is too large in a tree of rooms, in words."""
    found = []
    for folder in (tree, *(path for path in sorted(tree.rglob("*")) if path.is_dir() and path.name != "__pycache__")):
        files = [path for path in sorted(folder.glob("*.py")) if path.name != "__init__.py"]
        rooms = [path for path in folder.iterdir() if path.is_dir() and any(path.rglob("*.py"))]
        lines = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in files}
        found += [f"{folder}: {len(files)} files"] if len(files) > FILES else []
        found += [f"{folder}: {len(rooms)} rooms"] if len(rooms) > BELOW else []
        found += [f"{path}: {count} lines" for path, count in lines.items() if count > LINES]
    return found


@pytest.mark.parametrize("tree", TREES)
def test_rooms_and_files_are_small(tree: str) -> None:
    """At most 16 files a room, 12 rooms a level and 300 lines a file."""
    assert sizes(ROOT / tree) == []


def test_what_is_too_large_is_found(tmp_path: Path) -> None:
    """A room with a file too many, a level with a room too many and a file with 301 lines are named."""
    for number in range(FILES + 1):
        (tmp_path / f"file_{number}.py").write_text("\n" * (LINES + (number == 0)))
    for number in range(BELOW + 1):
        (tmp_path / f"room_{number}").mkdir()
        (tmp_path / f"room_{number}" / "file.py").touch()
    assert sizes(tmp_path) == [
        f"{tmp_path}: {FILES + 1} files", f"{tmp_path}: {BELOW + 1} rooms", f"{tmp_path / 'file_0.py'}: 301 lines",
    ]


def test_the_design_page_has_every_room() -> None:
    """The table of docs/design.md names the rooms of the list, in its order of packages."""
    text = (ROOT / "docs/design.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ((?:`[\w.]+`(?:, )?)+) \|", text, re.MULTILINE)
    named = [name for row in rows for name in re.findall(r"`([\w.]+)`", row)]
    rooms = [name.replace("evolvent_meshes", "meshes") for name in named]
    assert sorted(rooms) == sorted(ROOMS)
    order = {name: at for at, name in enumerate(rooms)}
    below = [(name, target) for name, entries in ROOMS.items() for entry in entries for target in ROOMS
             if allows(entry, target) and order[target] > order[name]]
    assert below == []
