"""What the process of a study has a worker process do: each order is answered once."""

from __future__ import annotations

import pickle
from dataclasses import dataclass

from evolvent.gears.load_list import LoadList
from evolvent.run.study.misalignment_line import solve_line
from evolvent.run.study.results.scene_record import SceneRecord
from evolvent.run.study.scene_task import condense, solve
from evolvent.run.study.task_groups import Line

Answer = bytes | list[SceneRecord] | None


@dataclass(frozen=True)
class Condense:
    """Condense the gears that scenes share, and keep them. Answer: the gears, pickled, where others need them."""

    tasks: Line
    """All that share them."""
    are_sent: bool
    """Whether other workers need them."""
    deaths: int = 0
    """Of workers at this order."""

    def carried_out(self, gears: LoadList | None) -> tuple[LoadList | None, Answer]:
        """The gears to keep, and the answer. gears: those that were kept."""
        made = condense(self.tasks)
        return made, pickle.dumps(made) if self.are_sent else b""


@dataclass(frozen=True)
class Keep:
    """Keep gears that another worker has condensed. Answer: None."""

    gears: bytes
    """Pickled."""
    deaths: int = 0
    """Of workers at this order."""

    def carried_out(self, gears: LoadList | None) -> tuple[LoadList | None, Answer]:
        """See `Condense.carried_out`."""
        return pickle.loads(self.gears), None


@dataclass(frozen=True)
class Solve:
    """Compute scenes. Answer: their records."""

    line: Line
    """The scenes."""
    on_kept_gears: bool
    """Whether on those that the worker keeps; else it drops these, and a scene condenses its own."""
    deaths: int = 0
    """Of workers at this order."""

    def carried_out(self, gears: LoadList | None) -> tuple[LoadList | None, Answer]:
        """See `Condense.carried_out`."""
        if self.on_kept_gears:
            assert gears is not None
            return gears, solve_line(self.line, gears)
        return None, [solve(task) for task in self.line]


@dataclass(frozen=True)
class Failure:
    """The answer to an order that has ended with an error of the program."""

    reason: str
    """The error's type and message."""


Order = Condense | Keep | Solve
