"""`python -m evidence.pages.papers.he_bodies --out DIR`: He's pair on rigid and elastic bodies beside its modes.

For docs/dynamics.md: the peak-to-peak transmission error of the torsional model on both kinds of gear bodies, at speeds
up to and beyond that at which the third mesh harmonic excites the bodies themselves, against transient contact with the
natural modes of both gears; with a backlash and a damping with which flanks do not part. Runs that an earlier call has
ended are read again. `python -m evidence.pages` then writes the page.
"""

from __future__ import annotations

import json
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
    for positions, speeds in STEPS.items():
        words = _words("transient", f"transient.speeds_rpm={list(speeds)}", f"sweep.positions={positions}",
                       "transient.mesh_periods=300", "transient.steady_change=0.001")
        folder, _ = runs.ended(f"modes_{positions}", "transient.json", *words)
        for speed, fact in zip(speeds, json.loads((folder / "transient.json").read_text(encoding="utf-8"))):
            yield f"modes_{speed}_um", fact["peak_to_peak_um"]
            yield f"modes_{speed}_apart_percent", 100.0 * fact["separated"]
            yield f"modes_{speed}_steady", float(fact["steady"])


def _words(command: str, *settings: str) -> tuple[str, ...]:
    set_to = [f"--set={each}" for each in (*SETTINGS, *settings)]
    return module_run("evolvent", command, DEMOS / "he2022.toml", "--quiet", "--resume", *set_to)


def bodies_table(docs: Path) -> str:
    """Peak-to-peak transmission error at each speed, and how far both models are from the transient."""
    f = kept.kept(docs / KEPT, COMMAND)

    def cells(speed: int) -> tuple[str, ...]:
        wanted = f[f"modes_{speed}_um"]
        found = [f[f"{bodies}_{speed}_um"] for bodies in BODIES]
        return f"{speed}", *(f"{um:.2f} ({100.0 * (um / wanted - 1.0):+.1f} %)" for um in found), f"{wanted:.2f}"

    head = "speed [r/min]", *(f"{bodies} bodies [µm]" for bodies in BODIES), "transient with modes of both bodies [µm]"
    return markdown(head, [cells(speed) for speed in SPEEDS], range(len(head)))


def bodies_limit(docs: Path) -> str:
    """Largest differences of elastic bodies from the transient, near the bodies' own vibration and elsewhere."""
    f = kept.kept(docs / KEPT, COMMAND)
    third = f["third_harmonic_rpm"]
    off = {speed: 100.0 * (f[f"elastic_{speed}_um"] / f[f"modes_{speed}_um"] - 1.0) for speed in SPEEDS}
    rigid = max(abs(100.0 * (f[f"rigid_{speed}_um"] / f[f"modes_{speed}_um"] - 1.0)) for speed in SPEEDS)
    near = {speed: each for speed, each in off.items() if abs(speed / third - 1.0) < NEAR}
    worst = min(near, key=lambda speed: near[speed])
    elsewhere = max(abs(each) for speed, each in off.items() if speed != worst)
    return (
        f"The bodies' own vibration on the mesh, {1e-3 * f['body_frequency_Hz']:.1f} kHz, is met by the third mesh "
        f"harmonic at {third:.0f} r/min: at {worst} r/min the peak-to-peak value on elastic bodies is off by "
        f"{near[worst]:+.1f} %, at the other speeds by up to {elsewhere:.1f} %; on rigid ones by up to {rigid:.0f} %."
    )


if __name__ == "__main__":
    keep_figures(__doc__, DOCS / KEPT, figures)
