"""Runs behind a page's figures, as processes, and the command line that keeps these; runs that an earlier call has
ended are read again."""

from __future__ import annotations

import argparse
import csv
import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from evidence.checkout import ROOT
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evidence.processes import Command, Cost, RunFailed, run

TIME_LIMIT = 7200.0  # s
Row = dict[str, str]


@dataclass(frozen=True)
class Runs:
    """Where the runs go."""

    out: Path

    def ended(self, name: str, leaves: str, *words: object, after: str = "") -> tuple[Path, Cost]:
        """The folder of a run and what it took. words: of the command. leaves: its last file. after: an ended run on
        a copy of whose folder this one begins, where the words have it go on. Raises RunFailed, also where the run that
        has ended there had other words. Whether program and scene have changed since is not looked at: take another
        folder then."""
        folder, cost = self.out / name, self.out / f"{name}.cost.csv"
        if cost.exists() and (folder / leaves).exists():
            self._require_same(name, words)
        else:
            self.out.mkdir(parents=True, exist_ok=True)
            if after:
                shutil.copytree(self.out / after, folder, dirs_exist_ok=True)
            took = run(Command((*map(str, words), "--out", str(folder)), ROOT, self.out / f"{name}.log",
                               time_limit=TIME_LIMIT))
            self._words(name).write_text(self._told(words), encoding="utf-8")
            cost.write_text(f"{took.wall},{took.cpu},{took.memory_MB}", encoding="utf-8")
        return folder, Cost(*map(float, cost.read_text(encoding="utf-8").split(",")))

    def _words(self, name: str) -> Path:
        return self.out / f"{name}.command.txt"

    def _require_same(self, name: str, words: Sequence[object]) -> None:
        """Raises RunFailed unless the run of this name had these words."""
        path, wanted = self._words(name), self._told(words)
        found = path.read_text(encoding="utf-8") if path.exists() else "of an unknown command"
        if found != wanted:
            raise RunFailed(
                f"{self.out / name}: wanted a run of\n{wanted}\nfound one that ended before,\n{found}\n"
                "take another --out, or remove it"
            )

    def _told(self, words: Sequence[object]) -> str:
        """The words of a command behind its program, one a line: the same wherever the checkout and the runs lie."""
        told = (str(word).replace(str(self.out), "OUT").replace(str(ROOT), ".") for word in words[1:])
        return "\n".join(told)


def read(path: Path) -> list[Row]:
    """The rows of a table."""
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def keep_figures(words: str | None, path: Path, figures: Callable[[Runs], Named]) -> None:
    """The command line of a script whose runs go to `--out`: keeps their figures. words: of its help."""
    parser = argparse.ArgumentParser(description=words)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    print(kept.keep(path, figures(Runs(parser.parse_args().out.resolve()))))
