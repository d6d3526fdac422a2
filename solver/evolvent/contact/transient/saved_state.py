"""A transient's state in a file, from which it goes on: a NumPy archive (.npz), written atomically.

It has the numbers of `Reached`, without what follows from the problem, and a digest of each part of the problem and of
the settings. Modes are computed anew. Amplitudes belong to those they were saved with; as other machines and libraries
may give modes with another sign, or others of one frequency, a projection of each is kept and compared.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from evolvent.contact.problem.definition import Problem
from evolvent.contact.step.step_solution import DeformedSurfaces
from evolvent.contact.transient.beginning import Reached
from evolvent.contact.transient.body_motion import BodyMotion
from evolvent.contact.transient.energy import EnergyBalance
from evolvent.contact.transient.moving_body import MovingBody
from evolvent.contact.transient.moving_response import MovingResponse
from evolvent.contact.transient.settings import TransientSettings
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, TimeScheme, TimeStep
from evolvent_meshes.arrays import Floats
from evolvent_meshes.digests import digest
from evolvent_meshes.errors import InputError
from evolvent_meshes.files import open_file, write_bytes
from evolvent_meshes.input_checks import Words, refuse

FORMAT = "evolvent transient 1"
KEPT = "modes", "damping_ratio", "spectral_radius", "conserving"
"""Settings that must be equal for a transient to be resumed; lengths of time steps may change."""
SAME = 1e-6
"""Largest accepted difference of a projection of a mode, over the largest projection of its body."""


def write_state(
    path: Path, problem: Problem, settings: TransientSettings, bodies: tuple[MovingBody, ...], reached: Reached
) -> Path:
    """Writes the state of a transient; returns the path. Replaces a state of the same problem and settings, and no
    other file. Raises InputError, WriteError."""
    parts = fingerprints(problem, settings)
    if path.exists():
        _require_same(path, _read(path, "name another file: others are not overwritten"), parts)
    balance = reached.balance
    arrays: dict[str, Any] = {
        "format": FORMAT, "names": list(parts), "digests": list(parts.values()),
        "times": [reached.time, reached.length, reached.next_length],
        "balance": [balance.first, balance.largest, balance.work, balance.added],
    }
    for i, (body, motion) in enumerate(zip(bodies, reached.motions)):
        arrays |= {f"body{i}_{name}": value for name, value in _motion_arrays(body, motion).items()}
    for i, surfaces in enumerate(reached.deformed.positions if reached.deformed else ()):
        arrays |= {f"contact{i}_first": surfaces[0], f"contact{i}_second": surfaces[1]}
    content = io.BytesIO()
    np.savez(content, **arrays)
    return write_bytes(path, content.getbuffer())


def read_state(path: Path, problem: Problem, settings: TransientSettings, bodies: tuple[MovingBody, ...]) -> Reached:
    """State that `write_state` wrote. Raises InputError for a file that is no state, or that of another problem."""
    arrays = _read(path, "give the path that Transient.save returned")
    _require_same(path, arrays, fingerprints(problem, settings))
    scheme = TimeScheme(settings.spectral_radius)
    motions = tuple(_motion(path, arrays, i, body, scheme) for i, body in enumerate(bodies))
    deformed = DeformedSurfaces(
        tuple((arrays[f"contact{i}_first"], arrays[f"contact{i}_second"]) for i in range(len(problem.contacts)))
    )
    time, length, next_length = arrays["times"].tolist()
    return Reached(time, length, next_length, motions, deformed, EnergyBalance(*arrays["balance"].tolist()))


def _motion_arrays(body: MovingBody, motion: BodyMotion) -> dict[str, Any]:
    state, response = motion.state, motion.response
    return {
        "state": [state.position, state.velocity, state.acceleration], "lag": motion.lag, "forces": motion.forces,
        "factor": response.factor, "resultant": response.resultant, "prescribed": response.prescribed,
        "modes": _projections(body),
    }


def _motion(path: Path, arrays: Mapping[str, Any], index: int, body: MovingBody, scheme: TimeScheme) -> BodyMotion:
    kept = {name.partition("_")[2]: value for name, value in arrays.items() if name.startswith(f"body{index}_")}
    found, wanted = kept["modes"], _projections(body)
    if np.abs(found - wanted).max(initial=0.0) > SAME * np.abs(wanted).max(initial=0.0):
        refuse(
            f"{path}", f"amplitudes of the modes of body {index} as they are computed here", Words("those of others"),
            "go on where the state was saved, with the same versions of SciPy and PETSc, or begin anew",
        )
    factor, resultant, prescribed = float(kept["factor"]), kept["resultant"], kept["prescribed"]
    response = MovingResponse(body, TimeStep.unused(body.system, scheme), factor, resultant, prescribed)
    return BodyMotion(KinematicState(*kept["state"]), kept["lag"], response, kept["forces"])


def _projections(body: MovingBody) -> Floats:
    """Projection of each mode on one fixed field (m,)."""
    shapes = body.modes.shapes
    return np.asarray(np.cos(np.arange(len(shapes))) @ shapes)


def _read(path: Path, remedy: str) -> dict[str, Any]:
    """The arrays of a state. Raises InputError."""
    try:
        with open_file(path) as file, np.load(file, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (OSError, ValueError, EOFError, AttributeError, TypeError, zipfile.BadZipFile) as error:
        raise InputError(f"{path}: wanted a transient's saved state, found none ({error}); {remedy}") from error
    if str(arrays.get("format")) != FORMAT:
        refuse(f"{path}", f"a state of the format {FORMAT!r}", str(arrays.get("format")), remedy)
    return arrays


def fingerprints(problem: Problem, settings: TransientSettings) -> dict[str, str]:
    """Name -> digest of each body and contact, of Nitsche's method, and of each of the settings that are kept."""
    parts: dict[str, object] = {f"body {i} ({body.name!r})": body for i, body in enumerate(problem.bodies)}
    parts |= {f"contact {i}": contact for i, contact in enumerate(problem.contacts)}
    parts |= {"nitsche": problem.nitsche}
    parts |= {f"setting {name}": getattr(settings, name) for name in KEPT}
    return {name: digest(part) for name, part in parts.items()}


def _require_same(path: Path, arrays: Mapping[str, Any], parts: Mapping[str, str]) -> None:
    """Raises InputError for a state of another problem, or with other settings, and names what differs."""
    kept = dict(zip(arrays["names"].tolist(), arrays["digests"].tolist()))
    other = [name for name in [*parts, *(name for name in kept if name not in parts)]
             if kept.get(name) != parts.get(name)]
    if other:
        refuse(
            f"{path}", "the state of this problem with these settings", Words(f"another {', '.join(other)}"),
            "take the problem and the settings that it was saved with, or another file",
        )
