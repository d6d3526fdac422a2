"""Picture of root stress: over the rotation of a tooth, beside the formulas."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.results.drawing.style import INK, foot, friction_colours, sheet
from evolvent.strength.results.tables import STANDARD, RootStressRow, StrengthRow
from evolvent_meshes.gears.member import Member

MARKS = {"ISO": "s", "equal": "o", "Pedrero": "D"}
"""First word of a method -> its marker."""
SIZES = {f"{STANDARD}2006": 12.5, "equal": 10.0, "Pedrero": 6.0, f"{STANDARD}2019": 3.0}
"""Beginning of a method -> size of its marker: on a spur pair several lie at one point, the larger ones below."""
LINES: dict[str, str] = {f"{STANDARD}2006": ":", f"{STANDARD}2019": "-."}
"""Method of the standard -> style of its line."""


def root_stress_figure(title: str, curves: Sequence[RootStressRow], rows: Sequence[StrengthRow]) -> Figure:
    """Largest tension of the loaded side and compression of the back over the rotation of a tooth, a column a gear; the
    formulas at the rotation of their load.

    title: of the scene. curves: of finite elements; rows: by each way; both of both gears.
    """
    head = "Root stress over the engagement of a tooth"
    figure = sheet(head, f"{title}. Nominal, without load factors.", (11.0, 6.2))
    axes = figure.subplots(1, 2, sharey=True)
    frictions = list(dict.fromkeys(row.friction for row in curves))
    colours = friction_colours(frictions)
    for member, own in zip(Member, axes):
        for friction, colour in zip(frictions, colours):
            curve = [row for row in curves if (row.gear, row.friction) == (member.label, friction)]
            for name, style in (("tension_MPa", "-"), ("compression_MPa", "--")):
                stress = [getattr(row, name) for row in curve]
                own.plot([row.tooth_rotation_deg for row in curve], stress, style, color=colour, lw=1.6)
        _formulas(own, [row for row in rows if row.gear == member.label and np.isnan(row.friction)])
        own.axhline(0.0, color=INK, lw=0.6)
        own.set_title(member.label)
        own.set_xlabel("pinion rotation from the pitch point [°]")
    axes[0].set_ylabel("principal stress at the root [MPa]")
    for friction, colour in zip(frictions, colours):
        axes[0].plot([], [], color=colour, label=f"finite elements, μ = {friction:g}")
    axes[1].legend(*_named(axes), loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8.0)
    foot(figure, "Full: largest tension of the loaded side; dashed: compression of the back.")
    return figure


def _formulas(axes: Axes, rows: Sequence[StrengthRow]) -> None:
    """Draws formulas that know the rotation of their load as marks, others as lines."""
    for row in rows:
        word = row.method.split()[0].split("'")[0]
        if np.isnan(row.tooth_rotation_deg):
            axes.axhline(row.stress_MPa, color=INK, lw=0.9, ls=LINES[row.method], label=row.method)
        else:
            filled = INK if row.method == f"{STANDARD}2019" else "none"
            size = next(size for name, size in SIZES.items() if row.method.startswith(name))
            axes.plot(row.tooth_rotation_deg, row.stress_MPa, MARKS[word], mfc=filled, mec=INK, ms=size,
                      zorder=4.0 - 0.1 * size, label=row.method.split(",")[0], ls="none")


def _named(axes: Sequence[Axes]) -> tuple[list[object], list[str]]:
    """Handles and labels of the legend, each label once."""
    both = [pair for own in axes for pair in zip(*own.get_legend_handles_labels())]
    known = {label: handle for handle, label in both}
    names = sorted(known, key=lambda name: not name.startswith("finite"))
    return [known[name] for name in names], names
