"""Parts of docs/studies.md: the keys of a study file, the figures that it can name, and what was measured."""

from __future__ import annotations

from pathlib import Path

from evidence.robustness.studies import TABLE
from evidence.tables import markdown
from evolvent.run.study.plan.study_file import COMPUTATIONS, FigureSection, LatinHypercubeSection, StudyFile
from evolvent.run.study.results.figures import CATALOGUE, DEFAULTS
from evolvent.scene.schema.section import SceneSection

SECTIONS: tuple[tuple[str, type[SceneSection]], ...] = (
    ("", StudyFile), ("latin_hypercube.", LatinHypercubeSection), ("figure.", FigureSection),
)


def keys() -> str:
    """A line a key: meaning, what is allowed, default."""
    rows = []
    for prefix, section in SECTIONS:
        for name, field in section.model_fields.items():
            if not isinstance(field.json_schema_extra, dict):
                continue  # a section, whose keys have lines of their own
            default = "required" if field.is_required() else _default(field.default)
            rows.append((f"`{prefix}{name}`", str(field.description), str(field.json_schema_extra["allowed"]), default))
    return markdown(("key", "meaning", "allowed", "default"), rows)


def _default(value: object) -> str:
    if value in (None, "", (), {}):
        return "not given"
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def figures() -> str:
    """A line a computation: figures with a name, those that are gathered by default in bold."""
    rows = []
    for compute in COMPUTATIONS:
        names = (each.name for each in CATALOGUE.get(compute, []))
        words = ", ".join(f"**`{name}`**" if name in DEFAULTS.get(compute, ()) else f"`{name}`" for name in names)
        rows.append((f"`{compute}`", words))
    return markdown(("`compute`", "figures"), rows)


def measured(docs: Path) -> str:
    """What `python -m evidence.robustness.studies`, `study_kills` and `study_map` have written."""
    rows = [row for name in ("measured", "kills", "map") for row in TABLE.read(docs / "studies" / f"{name}.csv")]
    return TABLE.markdown(rows)
