"""Bodies as a user names them: a body itself, or its index in the problem."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from evolvent.fem.body import Body, Freedom
from evolvent_meshes.input_checks import Words, is_index, members, refuse


def body_number(bodies: Sequence[Body], body: int | Body, what: str) -> int:
    """Index of a body in a problem; an index stays as it is.

    what: name of the input, for the message.
    Raises InputError for a body that is not among `bodies`, or several times.
    """
    if not isinstance(body, Body):
        return int(body)
    places = [index for index, each in enumerate(bodies) if each is body]
    if len(places) != 1:
        known = ", ".join(f"{each.name!r} ({index})" for index, each in enumerate(bodies))
        found = f"{body.name!r} {len(places)} times" if places else f"another body, {body.name!r}"
        remedy = "name its number" if places else "put this one into the problem; dataclasses.replace makes another one"
        refuse(what, f"a body that the problem has once, of {known}", Words(found), remedy)
    return places[0]


def is_body(value: object) -> bool:
    """Whether the value is a body or the index of one."""
    return isinstance(value, Body) or is_index(value)


def freedom_pairs(given: Any) -> tuple[tuple[int | Body, Freedom], ...]:
    """Pairs of a body, or its index, and a Freedom. Raises InputError."""
    if isinstance(given, Mapping):
        lists = {body: (each,) if isinstance(each, Freedom) else each for body, each in given.items()}
        example = '{block: Freedom("x", displacement=0.1)}'
        given = [(body, each) for body, some in lists.items()
                 for each in members("step, freedoms", some, (Freedom,), example)]
    example = '((0, Freedom("x", displacement=0.1)),)'
    pairs = members("step, freedoms", given, (tuple, list), example)
    for pair in pairs:
        if not (len(pair) == 2 and is_body(pair[0]) and isinstance(pair[1], Freedom)):
            refuse("step, freedoms", "pairs of a body's index and a Freedom", pair, f"write {example}")
    _refuse_repeated([(body, freedom.direction) for body, freedom in pairs])
    return tuple((body if isinstance(body, Body) else int(body), freedom) for body, freedom in pairs)


def _refuse_repeated(names: list[tuple[int | Body, str]]) -> None:
    """Raises InputError where a freedom of a body is named twice."""
    if len(set(names)) < len(names):
        found = Words([(body.name if isinstance(body, Body) else body, direction) for body, direction in names])
        refuse("step, freedoms", "each freedom of a body once", found, "leave out one of the two")
