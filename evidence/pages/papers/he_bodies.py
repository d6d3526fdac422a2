"""`python -m evidence.pages.papers.he_bodies --out DIR`: He's pair on rigid and elastic bodies beside its modes.

For docs/dynamics.md: the peak-to-peak transmission error and the largest mesh force over the static one of the
torsional model on both kinds of gear bodies, at speeds
up to and beyond that at which the third mesh harmonic excites the bodies themselves, against transient contact with the
natural modes of both gears; with a backlash and a damping with which flanks do not part. Runs that an earlier call has
ended are read again. `python -m evidence.pages` then writes the page.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from itertools import product
from pathlib import Path

import numpy as np

from evidence.checkout import DEMOS, DOCS
from evidence.pages.papers.he_runs import Vibration
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evidence.pages.papers.kept_runs.runs import Runs, keep_figures
from evidence.processes import module_run
from evidence.tables import markdown
from evolvent.dynamics.body_sentences import NEAR
from evolvent.scene.scene import load_scene

KEPT = "he2022/bodies.csv"
COMMAND = "python -m evidence.pages.papers.he_bodies --out DIR"
SPEEDS = 1000, 1500, 2000, 3000, 4000, 5000, 6000, 7000, 8000
"""r/min."""
STEPS = {160: SPEEDS[:3], 80: SPEEDS[3:]}
"""Time steps of the transient in a mesh period: fewer at slow speeds smear the vibration, which is quicker there."""
SETTINGS = (
    "mesh.level=quick", "sweep.positions=80", "contact.friction=0", "output.error_bars=false",
    "output.animation=false", "dynamics.backlash_um=200", "dynamics.torque_percents=[10,25,50,75,100,150,200]",
    "dynamics.speeds=2",
)
BODIES = "rigid", "elastic"


def figures(runs: Runs) -> Named:
    """(name, value) of each figure. Raises RunFailed."""
    teeth = load_scene(DEMOS / "he2022.toml").pinion.teeth
    for bodies, speeds in product(BODIES, (SPEEDS[:5], SPEEDS[5:])):  # a call has six histories at most
        name, first = f"{bodies}_{speeds[0]}", f"{BODIES[0]}_{SPEEDS[0]}"
        words = _words("dynamics", f"dynamics.histories_rpm={list(speeds)}", f'dynamics.bodies="{bodies}"')
        folder, _ = runs.ended(name, "dynamics.json", *words, after="" if name == first else first)
        swept = Vibration.read(folder)
        own = swept.facts["body_frequency_Hz"]
        if own is not None and speeds[0] == SPEEDS[0]:
            yield "body_frequency_Hz", own
            yield "third_harmonic_rpm", 60.0 * own / (3.0 * teeth)
        for speed in speeds:
            yield f"{bodies}_{speed}_um", float(np.ptp(swept.motion(speed, "up")["transmission_error_um"]))
            yield f"{bodies}_{speed}_force", swept.at("dynamic_factor", speed)
    for positions, speeds in STEPS.items():
        words = _words("transient", f"transient.speeds_rpm={list(speeds)}", f"sweep.positions={positions}",
                       "transient.mesh_periods=300", "transient.steady_change=0.001")
        folder, _ = runs.ended(f"modes_{positions}", "transient.json", *words)
        for speed, fact in zip(speeds, json.loads((folder / "transient.json").read_text(encoding="utf-8"))):
            yield f"modes_{speed}_um", fact["peak_to_peak_um"]
            yield f"modes_{speed}_force", fact["dynamic_factor"]
            yield f"modes_{speed}_apart_percent", 100.0 * fact["separated"]
            yield f"modes_{speed}_steady", float(fact["steady"])


def _words(command: str, *settings: str) -> tuple[str, ...]:
    set_to = [f"--set={each}" for each in (*SETTINGS, *settings)]
    return module_run("evolvent", command, DEMOS / "he2022.toml", "--quiet", "--resume", *set_to)


def bodies_table(docs: Path) -> str:
    """Peak-to-peak transmission error and largest mesh force at each speed, and how far both models are from the
    transient."""
    f = kept.kept(docs / KEPT, COMMAND)

    def cells(speed: int) -> list[str]:
        found = [f"{speed}"]
        for what in ("um", "force"):
            for bodies in BODIES:
                found.append(f"{f[f'{bodies}_{speed}_{what}']:.2f} ({_off(f, bodies, speed, what):+.1f} %)")
            found.append(f"{f[f'modes_{speed}_{what}']:.2f}")
        return found

    names = *(f"{bodies} bodies" for bodies in BODIES), "modes of both bodies"
    head = "speed [r/min]", *(f"{name} [µm]" for name in names), *(f"force, {name}" for name in names)
    return markdown(head, [cells(speed) for speed in SPEEDS], range(len(head)))


def bodies_limit(docs: Path) -> str:
    """Largest differences of elastic bodies from the transient, near the bodies' own vibration and elsewhere."""
    f = kept.kept(docs / KEPT, COMMAND)
    third, (low, high) = f["third_harmonic_rpm"], NEAR
    near = [speed for speed in SPEEDS if low < speed / third < high]

    def largest(bodies: str, what: str, speeds: Iterable[int]) -> float:
        return max(abs(_off(f, bodies, speed, what)) for speed in speeds)

    def at(speed: int) -> str:
        both = (f"{_off(f, 'elastic', speed, what):+.1f} %" for what in ("um", "force"))
        return f"at {speed} r/min, {speed / third:.2f} times that, by {' and '.join(both)}"

    others = [speed for speed in SPEEDS if speed not in near]
    elastic, rigid = ([largest(bodies, what, speeds) for what in ("um", "force")]
                      for bodies, speeds in (("elastic", others), ("rigid", SPEEDS)))
    return (
        f"The bodies' own vibration on the mesh, {1e-3 * f['body_frequency_Hz']:.1f} kHz, is met by the third mesh "
        f"harmonic at {third:.0f} r/min. Between {low:g} and {high:g} times that speed peak-to-peak value and largest "
        f"force on elastic bodies are off {', '.join(map(at, near))}; at the other speeds by up to "
        f"{elastic[0]:.1f} and {elastic[1]:.1f} %; on rigid ones by up to {rigid[0]:.0f} and {rigid[1]:.0f} %."
    )


def _off(figures: Mapping[str, float], bodies: str, speed: int, what: str) -> float:
    """How far a model is from the transient [%]. what: um or force."""
    return 100.0 * (figures[f"{bodies}_{speed}_{what}"] / figures[f"modes_{speed}_{what}"] - 1.0)


if __name__ == "__main__":
    keep_figures(__doc__, DOCS / KEPT, figures)
