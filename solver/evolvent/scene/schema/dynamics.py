"""The sections [dynamics], vibration that the mesh excites, and [transient], contact of a pair with inertia."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, field_validator, model_validator

from evolvent.scene.schema.errors import NOTHING, InputProblem, shown, validation_error
from evolvent.scene.schema.loading import MOST_TORQUES
from evolvent.scene.schema.section import SceneSection, as_tuple, key, listed

MOST_SPEEDS = 5000
"""Largest number of speeds of a sweep."""
FASTEST = 1e6
"""Highest speed that a scene may have [r/min]."""
SPEEDS = f"two rising numbers above 0 up to {FASTEST:g}, in r/min"
HISTORIES = f"a list of up to 6 different speeds above 0 up to {FASTEST:g}, in r/min"
PERCENTS = "different numbers above 0 up to 1000, 100 among them"
MAP = 2, 12
"""Smallest and largest number of torques of a map."""
MAP_RANGE = 1.0, 400.0
"""Smallest and largest torque of a map [%]."""
MAP_PERCENTS = f"{MAP[0]} to {MAP[1]} different numbers from {MAP_RANGE[0]:g} to {MAP_RANGE[1]:g}"

TRANSIENT_SPEEDS = f"a list of 1 to 12 different speeds above 0 up to {FASTEST:g}, in r/min"
MANY_PARTS, MOST_PARTS = 64, 1024
"""Largest number of time steps from one position to the next: default, and upper limit that a scene may set."""
DEVIATION = "a number above 0 up to 1000, in µm: no gear is perfect"
PARTS = f"a power of two from 2 to {MOST_PARTS}"
DAMPING = 1e-3, 1.0
"""Smallest and largest damping ratio of a mesh. Without any, free vibration never dies away."""
DAMPING_WANTED = f"a number from {DAMPING[0]:g} to {DAMPING[1]:g}"
USUAL_DAMPING = "gear pairs have 0.02 to 0.1"
TONNE_PER_MM3 = 1e-12
"""Density of 1 kg/m³ [t/mm³]."""
Speed = Annotated[float, Field(gt=0, le=FASTEST)]


def _inertia(gear: str) -> Any:
    """Declares the key of a moment of inertia."""
    return key(
        f"moment of inertia of the {gear} with all that turns rigidly with it; by default that of its body, from "
        "geometry and density",
        "a number from 1e-12 to 1e9, in kg·m²",
        "mind the unit: 1 kg·m² is 1e6 kg·mm²; or delete the key",
        default=None, ge=1e-12, le=1e9,
    )


def _list_remedy(given: tuple[float, ...], wrong: list[float], why: str, lacking: str) -> str:
    """Remedy for an invalid list of torques. wrong: torques beyond its limits. why: what is said of them. lacking: the
    remedy where there are none, and each is there once."""
    if wrong:
        return f"leave out {shown(wrong[0])}{why}"
    twice = [each for each in given if given.count(each) > 1]
    return f"give {shown(twice[0])} once" if twice else lacking


class DynamicsSection(SceneSection):
    """[dynamics]: torsional vibration of both gears on their mesh, over the speed. `evolvent dynamics` reads it, and
    `evolvent run` where it has an operating speed."""

    speed_rpm: tuple[float, float] | None = key(
        "lowest and highest speed of the pinion; by default from a sixth to 1.6 of the speed at which the mesh "
        "frequency is the natural one",
        SPEEDS,
        "give the lower speed first, or delete the key",
        default=None,
    )
    speeds: int = key(
        "number of speeds, evenly spaced", f"a whole number from 2 to {MOST_SPEEDS}", default=400, ge=2, le=MOST_SPEEDS
    )
    mesh: Literal["force_surface", "tangent", "secant"] = key(
        "the mesh force: as computed over deflection and rotation, or the tangent or secant stiffness under the torque "
        "times the deflection",
        '"force_surface", "tangent" or "secant"',
        'give "tangent" or "secant" for a force linear in the deflection, "force_surface" for the computed one',
        default="force_surface",
    )
    bodies: Literal["elastic", "rigid"] = key(
        "the gear bodies: they give way with their inertia where it is, or they are rigid, with all inertia at the "
        "bores and what gives way between bore and mesh in front of it, so that a small bore has too low a natural "
        "speed, as in papers' models with one degree of freedom",
        '"elastic" or "rigid"',
        default="elastic",
    )
    torque_percents: tuple[float, ...] = key(
        "torques of the force surface, in percent of load.torque_Nm; beyond the heaviest it goes on straight",
        f"a list of up to {MOST_TORQUES} {PERCENTS}",
        "a force of twice the static one is usual near resonance: go on to 200",
        default=(5.0, 15.0, 30.0, 50.0, 75.0, 100.0, 150.0, 200.0), max_length=MOST_TORQUES,
    )
    damping_ratio: float = key(
        "damping of the mesh over the critical one, at the mean stiffness with what gives way in series",
        DAMPING_WANTED, USUAL_DAMPING, default=0.05, ge=DAMPING[0], le=DAMPING[1],
    )
    damping_in_separation: bool = key(
        "whether it acts in free flight, too, as in the model of He et al. 2022", "true or false", default=False
    )
    ground_damping_ratio: float = key(
        "damping of the shafts against the ground, likewise", "a number from 0 to 1", default=0.0, ge=0, le=1
    )
    backlash_um: float | None = key(
        "backlash along the line of action in the transverse section, from flank to flank; by default that of the "
        "gears' tooth thicknesses at their centre distance, where these give one",
        "a number from 0 to 1e5, in µm", "delete the key for the default", default=None, ge=0, le=1e5,
    )
    density_kg_m3: float = key(
        "density of both gears", "a number from 100 to 30000, in kg/m³", "steel has 7850", default=7850.0, ge=100,
        le=30000,
    )
    pinion_inertia_kg_m2: float | None = _inertia("pinion")
    wheel_inertia_kg_m2: float | None = _inertia("wheel")
    series_stiffness_N_per_um: float | None = key(
        "stiffness along the line of action of what gives way in line with the mesh, without inertia, such as a "
        "torsional compliance that is fitted to a measured resonance; no bearing whose lateral mode matters, which "
        "lies behind the gear's mass; by default nothing gives way",
        "a number from 0.001 to 1e9, in N/µm", "delete the key for the default", default=None, ge=1e-3, le=1e9,
    )

    operating_rpm: float | None = key(
        "speed of the pinion at which `evolvent run` computes contact and wear, under the mesh force of the vibration; "
        "by default under the constant torque",
        f"a number above 0 up to {FASTEST:g}, in r/min", "delete the key for the default", default=None, gt=0,
        le=FASTEST,
    )
    approach: Literal["run_up", "run_down"] = key(
        "from which side the pair has come to that speed, where its vibration depends on it: running up or down",
        '"run_up" or "run_down"', needs=("operating_rpm",), default="run_up",
    )

    histories_rpm: tuple[float, ...] = key(
        "speeds of the pinion of which the motion over time is written and drawn; they join those of `speeds`",
        HISTORIES, "take the speeds of interest from response.csv", default=(), max_length=6,
    )
    map_percents: tuple[float, ...] = key(
        "torques under which the speeds are run through, too, for a map of the vibration over speed and torque, in "
        "percent of load.torque_Nm; they need not be among torque_percents; by default there is no map",
        f"a list of {MAP_PERCENTS}, none above the heaviest of torque_percents",
        "resonance takes two to three times the static force: go on to a third of the heaviest of torque_percents",
        default=(), max_length=MAP[1],
    )
    map_speeds: int = key(
        "number of speeds of that map, evenly spaced", f"a whole number from 2 to {MOST_SPEEDS}",
        needs=("map_percents",), default=100, ge=2, le=MOST_SPEEDS,
    )
    base_pitch_deviation_um: float | None = key(
        "f_pb, deviation of the transverse base pitch, the larger of both gears, for K_v of ISO 6336-1 beside the "
        "computed factor; without it and f_fα there is no K_v",
        DEVIATION, "it is f_pt cos α_t of ISO 1328-1", default=None, gt=0, le=1000,
    )
    profile_deviation_um: float | None = key(
        "f_fα, profile form deviation, likewise", DEVIATION, "ISO 1328-1 has it by the tolerance class", default=None,
        gt=0, le=1000,
    )
    tolerance_class: int | None = key(
        "of ISO 1328-1, the coarser of both gears, likewise; from 6 on tip relief does not count; by default it does",
        "a whole number from 1 to 12", "give base_pitch_deviation_um and profile_deviation_um, too: they do not follow "
        "from it here",
        default=None, ge=1, le=12,
    )
    flank_surface: Literal["hardened", "through_hardened", "cast_iron"] = key(
        "which running-in ISO 6336-1 reckons with: surface hardened or nitrided teeth, through hardened or normalised "
        "ones, or grey cast iron",
        '"hardened", "through_hardened" or "cast_iron"',
        needs=("base_pitch_deviation_um", "profile_deviation_um"),
        default="hardened",
    )
    contact_endurance_MPa: float | None = key(
        "σ_Hlim, allowable stress number, likewise: of through hardened teeth it decides the running-in, and of teeth "
        "without tip relief the relief that wear gives them; by default there is none",
        "a number from 100 to 3000, in MPa", "ISO 6336-5 has it", default=None, ge=100, le=3000,
    )

    @property
    def density(self) -> float:
        """Density of both gears [t/mm³]."""
        return TONNE_PER_MM3 * self.density_kg_m3

    @property
    def direction(self) -> Literal["up", "down"]:
        """Direction in which the speed changes until the pair runs at `operating_rpm`."""
        return "up" if self.approach == "run_up" else "down"

    _tuples = field_validator("speed_rpm", "torque_percents", "histories_rpm", "map_percents", mode="before")(listed)

    @model_validator(mode="after")
    def _ranges(self) -> Self:
        if (speeds := self.speed_rpm) and not 0.0 < speeds[0] < speeds[1] <= FASTEST:
            remedy = "give the lower speed first, or delete the key"
            raise validation_error(InputProblem("speed_rpm", shown(speeds), SPEEDS, remedy))
        given = self.torque_percents
        wrong = [each for each in given if not 0.0 < each <= 1000.0]
        if wrong or len(set(given)) < len(given) or 100.0 not in given:
            remedy = _list_remedy(given, wrong, ", which is not above 0 up to 1000", "add 100, the torque itself")
            raise validation_error(InputProblem("torque_percents", shown(given), PERCENTS, remedy))
        histories = self.histories_rpm
        if not all(0.0 < each <= FASTEST for each in histories) or len(set(histories)) < len(histories):
            remedy = "give each once" if len(set(histories)) < len(histories) else "speeds of response.csv fit"
            raise validation_error(InputProblem("histories_rpm", shown(histories), HISTORIES, remedy))
        return self

    @model_validator(mode="after")
    def _map(self) -> Self:
        given, heaviest = self.map_percents, max(self.torque_percents)
        if not given:
            return self
        wrong = [each for each in given if not MAP_RANGE[0] <= each <= MAP_RANGE[1]]
        if wrong or len(set(given)) < len(given) or len(given) < MAP[0]:
            remedy = f"{_list_remedy(given, wrong, '', 'add another torque')}, or delete the key for no map"
            raise validation_error(InputProblem("map_percents", shown(given), f"a list of {MAP_PERCENTS}", remedy))
        if max(given) > heaviest:
            allowed = f"none above {heaviest:g}, the heaviest of torque_percents: the force surface ends there"
            remedy = f"add {shown(max(given))} to torque_percents"
            raise validation_error(InputProblem("map_percents", shown(given), allowed, remedy))
        return self

    @model_validator(mode="after")
    def _endurance(self) -> Self:
        if self.flank_surface == "through_hardened" and self.contact_endurance_MPa is None:
            raise validation_error(
                InputProblem(
                    "contact_endurance_MPa", NOTHING, "σ_Hlim, with flank_surface = \"through_hardened\"",
                    "give it in MPa; ISO 6336-5 has it",
                )
            )
        return self


class TransientSection(SceneSection):
    """[transient]: `evolvent transient` reads it, with damping, density and inertias of [dynamics]."""

    speeds_rpm: Annotated[tuple[Speed, ...], BeforeValidator(as_tuple)] = key(
        "speeds of the pinion", TRANSIENT_SPEEDS, "write transient.speeds_rpm = [1500, 3000]", min_length=1,
        max_length=12,
    )
    drive: Literal["free", "constant_speed"] = key(
        "how the gears turn: both swing against each other, as in the torsional model, or the gear without the torque "
        "turns at constant speed, as behind a large flywheel",
        '"free" or "constant_speed"', default="free",
    )
    start: Literal["statics", "rest"] = key(
        "how the motion begins: under load at speed, from statics; or with a blow, one gear at its speed at once and "
        "the other one at rest, the flanks just touching. From rest the first two mesh periods are reported, too",
        '"statics" or "rest"', default="statics",
    )
    mesh_periods: int = key(
        "mesh periods that are computed at most, until the motion repeats", "a whole number from 2 to 10000",
        "raise it where a sentence says that a motion does not repeat yet", default=60, ge=2, le=10_000,
    )
    steady_change: float = key(
        "largest change of the transmission error from one mesh period to the next, over its peak-to-peak value, at "
        "which the motion counts as steady",
        "a number from 1e-6 to 0.1", default=0.005, ge=1e-6, le=0.1,
    )
    mode_damping_ratio: float = key(
        "damping of each natural mode of the gears, over its critical one", "a number from 0 to 1", default=0.01, ge=0,
        le=1,
    )
    modes_per_harmonic: int | None = key(
        "natural modes of each harmonic of the ring of teeth; by default all modes that have four time steps a "
        "period at the highest speed, and at least one of each harmonic",
        "a whole number from 0 to 50", "delete the key for the default", default=None, ge=0, le=50,
    )
    spectral_radius: float = key(
        "what a time step leaves of motions that are too fast for it", "a number from 0 to 1",
        "0.8 is usual; 0 for speeds at which a step takes several natural periods", default=0.8, ge=0, le=1,
    )
    tolerance: float | None = key(
        "estimated error of the speeds in a time step, in the norm of the kinetic energy, over the speed that the "
        "largest energy so far would give: a step from one of the sweep's positions to the next that has more, or "
        "cannot be solved, is taken in halves, quarters and so on; by default nothing is divided",
        "a number from 1e-6 to 1", "0.01 is coarse, 0.001 fine; delete the key for equal steps", default=None, ge=1e-6,
        le=1,
    )
    most_parts: int = key(
        "with a tolerance, equal parts into which the way from one position to the next is divided at most; a sentence "
        "says where they do not reach it",
        PARTS, f"{MANY_PARTS} is the default", needs=("tolerance",), default=MANY_PARTS, ge=2, le=MOST_PARTS,
    )

    @model_validator(mode="after")
    def _fitting(self) -> Self:
        if len(set(self.speeds_rpm)) < len(self.speeds_rpm):
            raise validation_error(
                InputProblem("speeds_rpm", shown(self.speeds_rpm), TRANSIENT_SPEEDS, "give each once")
            )
        if self.most_parts & (self.most_parts - 1):
            raise validation_error(
                InputProblem("most_parts", shown(self.most_parts), PARTS, f"{MANY_PARTS} is the default")
            )
        return self
