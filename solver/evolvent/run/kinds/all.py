"""All computations of a scene, for the command line, studies and `evolvent plot`. None is imported before it is
needed: PETSc and pyvista take seconds."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

from evolvent.scene.scene import Scene
from evolvent.scene.schema.design import PERCENTS

if TYPE_CHECKING:
    from evolvent.run.computation import Computation


@dataclass(frozen=True)
class Kind:
    """A computation, as the command line and a study file name it."""

    name: str
    """Name in a study, and of the command unless another one computes it."""
    computation: str
    """Module below `evolvent.run.kinds` and class, with a colon between."""
    help: str
    """Help of the command: what it computes."""
    examples: str
    """Command lines of the help."""
    folder: str = "Where tables and the picture go."
    """Help of --out."""
    percents: tuple[float, ...] = ()
    """Default of --percent; empty: there is no such option."""
    in_studies: bool = True
    """Whether a study can compute it of each of its scenes."""
    part_of: str = ""
    """Command that computes it; empty: the one of its own name."""

    @property
    def command(self) -> str:
        """Command that computes it."""
        return self.part_of or self.name

    def load(self) -> type[Computation[Any]]:
        """The class of the computation."""
        module, _, name = self.computation.partition(":")
        found: type[Computation[Any]] = getattr(import_module(f"evolvent.run.kinds.{module}"), name)
        return found


KINDS = (
    Kind(
        "run", "run:Run", """Compute a scene.

    The positions of one angular pitch 2π/z_1 (one mesh cycle) for every friction coefficient; tables, fields and
    pictures go to DIR.
    """, """\
evolvent run demos/yang2022.toml --out out/yang2022 --level quick
evolvent run demos/yang2022.toml --out out/t300 --set load.torque_Nm=300 --set contact.friction=[0,0.1]
mpirun -n 2 evolvent run demos/yang2022.toml --out out/yang2022 --resume""",
        folder="Where tables, fields and pictures go.",
    ),
    Kind("wear", "wear:Wear", "", "", part_of="run"),
    Kind(
        "loads", "loads:Loads", """Compute a scene under a list of loads.

    The gears are condensed once. DIR gets the folder of a run for each load, and loads.csv and pictures/loads.png.
    """, """\
evolvent loads demos/yang2022.toml --out out/loads --level quick
mpirun -n 2 evolvent loads demos/yang2022.toml --out out/loads --percent 25,50,100,150""",
        folder="For a folder of each load.", percents=(5.0, 10.0, 25.0, 50.0, 75.0, 100.0), in_studies=False,
    ),
    Kind(
        "losses", "losses:Losses", """Compute the friction loss of a pair over the torque.

    In percent of the input, and as a power, at every friction coefficient. The coefficient is the same at all speeds.
    """, """\
evolvent losses demos/yang2022.toml --out out/losses --level quick --set contact.friction=[0.05,0.1]
mpirun -n 2 evolvent losses demos/he2022.toml --out out/losses --percent 25,50,100 --set contact.friction=0.06""",
        percents=(10.0, 25.0, 50.0, 75.0, 100.0),
    ),
    Kind(
        "excitation", "excitation:Excitation", """Compute what a pair's mesh does to its vibration.

    Without friction, over one angular pitch: the unloaded transmission error, and under each of a list of torques the
    loaded one and the mesh stiffness, tangent and secant, with their mesh harmonics. The gears are condensed once.
    """, """\
evolvent excitation demos/he2022.toml --out out/excitation --set sweep.positions=40
mpirun -n 2 evolvent excitation demos/he2022.toml --out out/excitation --percent 10,50,100,200""",
        percents=(5.0, 15.0, 30.0, 50.0, 75.0, 100.0, 150.0, 200.0),
    ),
    Kind(
        "dynamics", "dynamics:Dynamics", """Compute the vibration of a pair over the speed.

    The excitation by its mesh, then steady states, jumps, spectra and the motions of a pair that runs up and down, with
    the dynamic factor of ISO 6336-1 beside, as the section [dynamics] of the scene says.
    """, """\
evolvent dynamics demos/he2022_dynamics.toml --out out/dynamics
evolvent dynamics demos/he2022_dynamics.toml --out out/dynamics --resume --set dynamics.damping_ratio=0.05""",
        folder="Where tables and pictures go.",
    ),
    Kind(
        "transient", "transient:Transient", """Compute a pair's contact with inertia, over time.

    At each speed of the section [transient] and each friction coefficient, until the motion repeats with the mesh:
    transmission error, mesh force and contact pressure, beside those without inertia.
    """, """\
evolvent transient demos/he2022.toml --out out/transient --level quick --set transient.speeds_rpm=[2000,3000]
mpirun -n 2 evolvent transient demos/yang2022.toml --out out/fast --level quick --set transient.speeds_rpm=[1500]
evolvent transient demos/he2022.toml --out out/transient --level quick --set transient.speeds_rpm=[2000,3000] \\
--resume""",
    ),
    Kind(
        "design", "design:Design", """Vary a pair's flank modifications and find the best.

    Reliefs, crownings and slopes as the section [design] says, under each of a list of torques: transmission error,
    K_Hβ, pressure and friction loss of variants in line contact, on gears that are condensed once; the best ones with
    the contact resolved beside.
    """, """\
evolvent design demos/he2022.toml --out out/design --set design.vary='[["both.tip_relief_um",0,30,2]]'
mpirun -n 2 evolvent design demos/yang2022_design.toml --out out/design""",
        percents=PERCENTS, in_studies=False,
    ),
    Kind(
        "strength", "strength:Strength", """Compute the stress at the roots of a pair's teeth.

    By finite elements over the whole engagement of a tooth, on both sides, beside ISO 6336-3 and formulas for chosen
    points of load. Nominal stresses: load factors multiply them.
    """, """\
evolvent strength demos/zhang2023.toml --out out/zhang2023 --set pinion.face_width_mm=25
evolvent strength demos/he2022.toml --out out/roots --level quick --set contact.friction=[0,0.1]""",
    ),
    Kind(
        "fatigue", "fatigue:Fatigue", """Compute what contact does to the flanks: criteria over flank and depth.

    Under the pressures and the friction of the contact solution, by several criteria, as the section [fatigue] says;
    lives at several friction coefficients relative to the first.
    """, """\
evolvent fatigue demos/yang2022.toml --out out/fatigue --level quick --set contact.friction=[0.132,0.107]
mpirun -n 2 evolvent fatigue demos/he2022.toml --out out/pitting --set fatigue.yield_stress_MPa=2000""",
    ),
)
"""The computations, in the order of the help."""


def kind_named(name: str) -> Kind:
    """The computation of this name."""
    return next(each for each in KINDS if each.name == name)


def kind_of(command: str, scene: Scene) -> Kind:
    """The computation that a command makes of a scene: `run` is wear where the scene has a section [wear]."""
    return kind_named("wear" if command == "run" and scene.wear is not None else command)
