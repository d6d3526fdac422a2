"""Orders from the process of a study to its worker processes; each is answered once."""

from __future__ import annotations

import pickle
from dataclasses import dataclass

from evolvent.gears.shared_gears import SharedGears
from evolvent.run.study.misalignment_line import solve_line
from evolvent.run.study.results.scene_record import SceneRecord
from evolvent.run.study.scene_task import condense, solve
from evolvent.run.study.task_groups import Line

Answer = bytes | list[SceneRecord] | None


@dataclass(frozen=True)
class Condense:
    """Order to condense the gears that scenes share, and to hold them. Answer: the gears, pickled, where other workers
    need them."""

    tasks: Line
    """All scenes that share the gears."""
    are_sent: bool
    """Whether other workers need the gears."""
    deaths: int = 0
    """Worker processes that ended unexpectedly at this order."""

    def carried_out(self, gears: SharedGears | None) -> tuple[SharedGears | None, Answer]:
        """Carries out the order. Returns the gears that the worker holds from then on, and the answer. gears: those
        that it held before."""
        made = condense(self.tasks)
        return made, pickle.dumps(made) if self.are_sent else b""


@dataclass(frozen=True)
class Keep:
    """Order to hold gears that another worker has condensed. Answer: None."""

    gears: bytes
    """Condensed gears, pickled."""
    deaths: int = 0
    """Worker processes that ended unexpectedly at this order."""

    def carried_out(self, gears: SharedGears | None) -> tuple[SharedGears | None, Answer]:
        """Carries out the order. Returns the gears that the worker holds from then on, and the answer. gears: those
        that it held before."""
        return pickle.loads(self.gears), None


@dataclass(frozen=True)
class Solve:
    """Order to compute scenes. Answer: their records."""

    line: Line
    """Scenes that are computed."""
    on_kept_gears: bool
    """Whether the scenes use the gears that the worker holds; else it drops these, and a scene condenses its own."""
    deaths: int = 0
    """Worker processes that ended unexpectedly at this order."""

    def carried_out(self, gears: SharedGears | None) -> tuple[SharedGears | None, Answer]:
        """Carries out the order. Returns the gears that the worker holds from then on, and the answer. gears: those
        that it held before."""
        if self.on_kept_gears:
            assert gears is not None
            return gears, solve_line(self.line, gears)
        return None, [solve(task) for task in self.line]


@dataclass(frozen=True)
class Failure:
    """Answer to an order that ended with an error of the program."""

    reason: str
    """The error's type and message."""


Order = Condense | Keep | Solve
