"""What generated pages should hold, from the code and from what was measured before.

A page that is written by hand has generated parts between two marks, `<!-- begin NAME: ... -->` and `<!-- end -->`.
"""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

from evidence import mutations
from evidence.benchmarks.accuracy import companion_positions, face_load, transient_bar_costs, transient_bars, two_level
from evidence.benchmarks.cache import kept, modifications
from evidence.benchmarks.line import accuracy, edges, face_ends, friction, starts
from evidence.checkout import ROOT
from evidence.pages import abilities, blow, outputs, promises, readme, tutorial
from evidence.pages.papers import he, he_bodies, he_models, he_transient, yang, yang_fatigue, yang_transient, zhang
from evidence.robustness import repeats, study_page


def generated(root: Path = ROOT) -> dict[Path, str]:
    """File -> what it should hold. Raises ValueError where a page lacks a part's marks."""
    docs = root / "docs"
    bars = promises.said(docs)
    first = root / "demos" / "first_pair.toml"
    parts = {
        root / "README.md": {
            "speed": readme.speed(docs), "bars": bars, "verification": readme.verification(docs),
            "accuracy": yang.accuracy(docs),
        },
        docs / "scene.md": {"levels": yang.levels(docs)},
        docs / "yang2022.md": {
            "accuracy": yang.accuracy(docs), "points": yang.points(docs), "transient": yang_transient.table(docs),
            "frictions": yang_transient.frictions_table(docs), "bars": yang_transient.bars_said(docs),
            "start": yang_transient.start(docs),
        },
        docs / "he2022.md": {
            "points": he.points(docs), "sensitivity": he.sensitivity(docs), "speeds": he_transient.speeds_table(docs),
            "modes": he_transient.modes_table(docs), "bores": he_transient.bores_table(docs),
            "holds": he_transient.holds(docs), "steps": he_transient.steps_table(docs),
            "models": he_models.models_table(docs),
        },
        docs / "dynamics.md": {"bodies": he_bodies.bodies_table(docs), "limit": he_bodies.bodies_limit(docs)},
        docs / "zhang2023.md": {"points": zhang.points(docs), "differences": zhang.differences(docs)},
        docs / "fatigue.md": {"friction": yang_fatigue.friction_table(docs), "fitted": yang_fatigue.fitted_table(docs)},
        docs / "transient.md": {"bars": transient_bars.said(docs), "costs": transient_bar_costs.said(docs)},
        docs / "transient_method.md": {"calculix": blow.table(docs), "smeared": he_transient.smeared(docs)},
        docs / "computation.md": {"abilities": abilities.table(docs)},
        docs / "checks.md": {"repeats": repeats.said(docs)},
        docs / "evidence.md": {
            "bars": bars, "face-load": face_load.table(docs), "companion": companion_positions.table(docs),
        },
        docs / "edges.md": {"seen": mutations.table(root)},
        docs / "cache.md": {"kept": kept.said(docs), "modifications": modifications.said(docs)},
        docs / "line_contact.md": {
            "face-ends": face_ends.said(docs), "accuracy": accuracy.said(docs),
            "beyond": accuracy.beyond(docs), "friction": friction.said(docs),
            "edges": edges.said(docs), "starts": starts.said(docs),
        },
        docs / "two_level.md": {"left-out": two_level.left_out(docs)},
        docs / "studies.md": {
            "keys": study_page.keys(), "figures": study_page.figures(), "measured": study_page.measured(docs),
        },
        docs / "tutorial.md": {
            "scene": tutorial.scene_text(first), "check": tutorial.check(first), "run": tutorial.run(docs),
            "figures": tutorial.figures(docs),
        },
    }
    pages = {page: _filled(page, texts) for page, texts in parts.items()}
    whole = "\n\n".join(part.strip() for part in outputs.page()) + "\n"
    return {**pages, docs / "outputs.md": whole, docs / "summary.schema.json": outputs.schema_text()}


def _filled(page: Path, parts: dict[str, str]) -> str:
    text = page.read_text(encoding="utf-8")
    for name, part in parts.items():
        mark = re.compile(rf"(<!-- begin {name}: [^\n]*? -->\n\n)(?:.*?\n\n)??(<!-- end -->)", re.DOTALL)
        if (count := len(mark.findall(text))) != 1:
            raise ValueError(f"{page}: wanted the marks of a part {name!r} once, found {count} of them")
        text = mark.sub(partial(_between, part), text)
    return text


def _between(part: str, marks: re.Match[str]) -> str:
    return f"{marks[1]}{part}\n\n{marks[2]}"
