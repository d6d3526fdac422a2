"""A gear pair under load, and how it is computed: all that the rooms of `gears` are given, as plain data."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from evolvent.fem.material import STEEL, Material
from evolvent.gears.problem.flank_deviations import FlankChart, FlankCharts
from evolvent.gears.problem.hertz_estimate import HertzEstimate
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import Words, both_gears, instance, number, one_of, refuse

Level = Literal["line", "quick", "standard", "fine"]
RESOLVED: tuple[Level, ...] = ("quick", "standard", "fine")
"""Levels that resolve the width of the contact."""
LEVELS: tuple[Level, ...] = ("line", *RESOLVED)
CellShape = Literal["hexahedron", "tetrahedron"]
SHAPES: tuple[CellShape, ...] = ("hexahedron", "tetrahedron")
WINDOW = 1.6
"""Half-width of the contact window in largest Hertz half-widths."""


LINE_CELLS = "hexahedron", 2, None, False
"""Cells, order, elements across the contact width and levels of meshes for line contact."""


@dataclass(frozen=True)
class MeshSettings:
    """How finely the sectors are meshed. Raises InputError.

    Examples:
        >>> MeshSettings("quick")
        MeshSettings(level='quick', elements_per_contact_width=None, shape='hexahedron', order=2, two_level=None)
    """

    level: Level = "standard"
    """Mesh level: `quick` for orientation, `standard` for results, `fine` for reference; `line` for line contact, which
    does not resolve the width of the contact (docs/line_contact.md)."""
    elements_per_contact_width: float | None = None
    """Elements across the Hertz width 2b_H; None: 1.7, 3 or 6 by the level, at least 3 on a stiff pinion."""
    shape: CellShape = "hexahedron"
    """Cells of sectors in space; plane sections have quadrilaterals or triangles."""
    order: Literal[1, 2] = 2
    """Order of the cells and of the displacement."""
    two_level: bool | None = None
    """Whether the loaded flanks are meshed in levels of their own on a coarse body, where the problem is in space; by
    default where one fine mesh would be large, its cells are hexahedra of order 2, and neither whole_gears nor
    fine_body is asked for (`evolvent.gears.meshing.levelled_meshes.is_two_level`)."""

    def __post_init__(self) -> None:
        one_of("mesh level", self.level, LEVELS)
        one_of("mesh shape", self.shape, SHAPES)
        one_of("mesh order", self.order, (1, 2))
        given = self.shape, self.order, self.elements_per_contact_width, bool(self.two_level)
        if self.level == "line" and given != LINE_CELLS:
            refuse("level", 'hexahedra of order 2 beside level "line", and nothing else', self, "leave the others out")
        if self.two_level and (self.shape, self.order) != ("hexahedron", 2):
            remedy = "leave them out, or two_level"
            refuse("two_level", "hexahedra of order 2", Words(f"{self.shape}, order {self.order}"), remedy)
        if self.elements_per_contact_width is not None:
            wanted, remedy = "a number above 0", "leave it out for that of the level"
            number("elements_per_contact_width", self.elements_per_contact_width, wanted, remedy, lambda n: n > 0.0)


@dataclass(frozen=True)
class GearOptions:
    """Options that compute parts in full. By default they are reduced, with the same result within a tolerance
    (docs/evidence.md)."""

    in_space: bool = False
    """Whether to solve in three dimensions also where all transverse sections are equal."""
    friction_terms: bool = False
    """Whether to keep tangential components and friction history also at μ = 0."""
    whole_engagement: bool = False
    """Whether to solve all pitches in which a tooth is in mesh; else one."""
    whole_gears: bool = False
    """Whether to condense all sectors of a gear in one mesh; else one sector that stands for all."""
    all_teeth: bool = False
    """Whether to search as many tooth pairs as the smaller gear has teeth; else those that can touch, and their
    neighbours."""
    whole_flanks: bool = False
    """Whether to search contact on the whole flanks; else in a window about each contact line."""
    deflected_flanks: bool = False
    """Whether to search contact again on the flanks as they have deflected."""
    fine_body: bool = False
    """Whether to mesh back flank, fillets, core and rim finely; else the loaded flank only."""


@dataclass(frozen=True, eq=False)
class GearProblem:
    """A gear pair under a constant torque; by default the pinion drives. Raises InputError.

    Examples:
        >>> from evolvent.gears import GearPair, GearParameters
        >>> rack = dict(normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0)
        >>> pinion = GearParameters.from_rack(z=30, bore_diameter=40.0, **rack)
        >>> wheel = GearParameters.from_rack(z=50, bore_diameter=60.0, **rack)
        >>> problem = GearProblem(GearPair(pinion, wheel, centre_distance=120.0), torque=150e3)
        >>> problem.is_plane, problem.contact_teeth
        (True, (-2, -1, 0, 1))
        >>> print(f"{float(problem.hertz_estimate.peak_pressure(0.0)):.0f} MPa at the pitch point")
        630 MPa at the pitch point
    """

    pair: GearPair
    """Both gears and the position of their axes."""
    torque: float
    """Constant torque on one gear, over its whole face [N·mm]."""
    torque_on: Member = Member.PINION
    """The gear with the torque; the rotation of the other one is prescribed."""
    materials: tuple[Material, Material] = (STEEL, STEEL)
    """Materials of pinion and wheel."""
    mesh: MeshSettings = MeshSettings()
    """Fineness and cells of the sectors' meshes."""
    flanks: FlankCharts = (None, None)
    """Measured or worn flanks of pinion and wheel; None: as designed. A chart that covers 80 % of its gear's face, its
    middle within 5 % of mid-face, is extended to the whole face, of which `condense` warns; less is refused."""
    options: GearOptions = GearOptions()
    """Options to compute parts in full."""
    mesh_torques: tuple[float, float] | None = None
    """Lightest and heaviest torque that the meshes serve, on the same gear as `torque` [N·mm]; None: `torque` alone. A
    lighter `torque` has elements too long for its pressures, which an excitation can do without. Up to the heaviest all
    problems have the same sectors and, on flanks with levels, so many of the same levels as each needs:
    `evolvent.gears.gear_model.condensed_gears` condenses them once."""
    driving: Member = Member.PINION
    """Gear that drives the other one. The flanks that bear are the same; where the wheel drives, both gears turn the
    other way round, and friction acts in the opposite direction."""

    def __post_init__(self) -> None:
        instance("pair", self.pair, GearPair, "write GearPair(pinion, wheel, centre_distance=...)")
        both_gears("materials", self.materials, Material)
        level = self.mesh if isinstance(self.mesh, str) else "standard"
        instance("mesh", self.mesh, MeshSettings, f'write MeshSettings("{level}")')
        both_gears("flanks", self.flanks, FlankChart, optional=True)
        object.__setattr__(self, "flanks", tuple(self._checked_flank(gear) for gear in Member))
        instance("options", self.options, GearOptions, "write GearOptions(in_space=True), for example")
        self._check_levels()
        remedy = "give it in N·mm and without a sign: `driving` is the gear that drives"
        number("torque", self.torque, "a finite number > 0 [N·mm]", remedy, lambda T: T > 0.0)
        one_of("torque_on", self.torque_on, tuple(Member))
        one_of("driving", self.driving, tuple(Member))
        lightest, heaviest = self._served
        if not (0.0 < lightest <= heaviest and self.torque <= heaviest):
            remedy = "give the lightest and the heaviest torque that the meshes serve"
            wanted = f"two ascending torques > 0, the second one at least {self.torque:g} N·mm"
            refuse("mesh_torques", wanted, self.mesh_torques, remedy)

    def _check_levels(self) -> None:
        """Raises InputError where flanks with levels of their own cannot be had."""
        if self.mesh.two_level and (self.options.whole_gears or self.options.fine_body):
            remedy = "leave out one of the two: they are the long way round that two_level saves"
            refuse("two_level", "without whole_gears and fine_body", self.options, remedy)
        if self.is_line and self.options.whole_gears:
            refuse("whole_gears", "sectors of gears for line contact", self.options, "leave it out, or the level")

    def _checked_flank(self, gear: Member) -> FlankChart | None:
        """The chart of a gear from the base circle on. Raises TableError where it does not fit the gear."""
        chart, geometry = self.flanks[gear], self.pair.gears[gear]
        active = self.pair.active_start_diameters[gear], geometry.tip_form_diameter
        return None if chart is None else chart.checked(f"flanks, {gear.label}", geometry, active)

    @property
    def extended_charts(self) -> dict[Member, str]:
        """Gear -> a phrase on its chart, where that does not end where the face does."""
        charts = zip(Member, self.pair.gears, self.flanks)
        return {m: words for m, gear, chart in charts if chart is not None and (words := chart.coverage(gear).words)}

    @cached_property
    def has_equal_sections(self) -> bool:
        """Whether all transverse sections are alike: a spur pair of one face width, without lead variation, whose
        bores are held over it and whose bodies have no web."""
        gears = self.pair.gears
        varies = (
            self.pair.pinion.helix_angle_deg, self.pair.misalignment_um,
            *(gear.modifications.varies_over_the_face for gear in gears),
            *(gear.support.is_partial(gear.face_width) or gear.thin_web is not None for gear in gears),
            *(chart is not None and chart.varies_over_the_face for chart in self.flanks),
        )
        return not any(varies) and gears[0].face_width == gears[1].face_width

    @property
    def base_radius(self) -> float:
        """Base radius of the gear with the torque [mm]."""
        return self.pair.gears[self.torque_on].base_radius

    @property
    def is_line(self) -> bool:
        """Whether it is solved in line contact."""
        return self.mesh.level == "line"

    @property
    def is_plane(self) -> bool:
        """Whether it is solved in plane strain."""
        return self.has_equal_sections and not self.options.in_space

    @property
    def pinion_torque(self) -> float:
        """Torque on the pinion without friction, over the whole face [N·mm]."""
        return self.torque if self.torque_on is Member.PINION else self.torque / self.pair.ratio

    @cached_property
    def hertz_estimate(self) -> HertzEstimate:
        """Hertz contact on the nominal contact lines."""
        return HertzEstimate.of(self.pair, self.materials, self.pinion_torque)

    @property
    def _served(self) -> tuple[float, float]:
        """The lightest and the heaviest torque that the meshes serve."""
        return (self.torque, self.torque) if self.mesh_torques is None else self.mesh_torques

    @cached_property
    def lightest(self) -> GearProblem:
        """Problem under the lightest torque that the meshes serve, whose contact is the narrowest."""
        return self._under(self._served[0])

    @cached_property
    def heaviest(self) -> GearProblem:
        """Problem under the heaviest torque that the meshes serve, whose contact is the widest."""
        return self._under(self._served[1])

    def _under(self, torque: float) -> GearProblem:
        """Problem under a torque; itself, with its computed values, where the torque is its own."""
        return self if torque == self.torque else replace(self, torque=torque)

    @cached_property
    def pitches(self) -> int:
        """Number of angular pitches 2π/z_1 that are swept: one, or all in which a tooth is in mesh."""
        if not self.options.whole_engagement:
            return 1
        return math.ceil(self.pair.engagement_angle * self.pair.pinion.z / (2 * math.pi))

    @cached_property
    def touching_teeth(self) -> range:
        """Tooth pairs that can touch while the pinion turns from 0 through all pitches, on rigid flanks."""
        last = self.pair.teeth_in_contact(0.0)
        first = self.pair.teeth_in_contact(self.pitches * 2 * math.pi / self.pair.pinion.z)
        return range(first[0], last[-1] + 1)

    @cached_property
    def contact_teeth(self) -> tuple[int, ...]:
        """Tooth pairs that are searched: those that can touch and their neighbours, which deflection may bring into
        contact; or as many as the smaller gear has."""
        near = range(self.touching_teeth[0] - 1, self.touching_teeth[-1] + 2)
        if not self.options.all_teeth:
            return tuple(near)
        count = min(gear.z for gear in self.pair.gears)
        first = (near[0] + near[-1]) // 2 - count // 2
        return tuple(range(first, first + count))

    @cached_property
    def window_half_width(self) -> float:
        """Half-width [mm of profile arc] of the contact window; infinite for whole flanks. The same everywhere: beyond
        the path of contact deflection brings more into contact than Hertz's width there."""
        if self.options.whole_flanks:
            return float(np.inf)
        ξ = np.linspace(*self.pair.path_of_contact, 50)
        return WINDOW * float(np.max(self.hertz_estimate.half_width(ξ)))
