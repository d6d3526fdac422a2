"""The sections [material] and [mesh]: the elastic bodies of both gears, and their finite elements."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator

from evolvent.scene.schema.section import SceneSection, key


def _modulus(default: float | None) -> Any:
    """Declares the key of Young's modulus."""
    allowed, remedy = "a number from 0.001 to 2000, in GPa", "steel is 210; mind GPa, not MPa"
    return key("Young's modulus E", allowed, remedy, default=default, ge=1e-3, le=2000)


def _ratio(default: float | None) -> Any:
    """Declares the key of Poisson's ratio."""
    return key("Poisson's ratio ν", "a number from 0 to 0.49", "steel is 0.3", default=default, ge=0, le=0.49)


class GearMaterialSection(SceneSection):
    """[material.pinion] and [material.wheel]: deviations from [material]."""

    E_GPa: float | None = _modulus(None)
    nu: float | None = _ratio(None)


class MaterialSection(SceneSection):
    """[material]: linear elasticity of both gears, unless a subsection deviates."""

    E_GPa: float = _modulus(210.0)
    nu: float = _ratio(0.3)
    pinion: GearMaterialSection = GearMaterialSection()
    wheel: GearMaterialSection = GearMaterialSection()


Level = Literal["line", "quick", "standard", "fine"]
FEWEST_ELEMENTS = 0.5
"""Smallest number of elements across the contact width."""


def _whole(value: Any) -> int:
    """Refuses what is no int: in Python, true == 1 and 2.0 == 2. Raises ValueError."""
    if type(value) is not int:
        raise ValueError
    return value


class MeshSection(SceneSection):
    """[mesh]: the finite elements of both sectors."""

    level: Level = key(
        "how fine",
        '"line", "quick", "standard" or "fine"',
        "quick is for orientation, standard for results; line does not resolve the contact's width",
        default="standard",
    )
    elements_per_contact_width: float | None = key(
        "elements across the Hertz width 2b_H; quick 1.7, standard 3 (3.75 on [flanks with levels](two_level.md)), "
        "fine 6 by default, on a stiff pinion at least 3",
        f"a number from {FEWEST_ELEMENTS:g} to 24",
        "delete the key for the level's own",
        default=None,
        ge=FEWEST_ELEMENTS,
        le=24,
    )
    shape: Literal["hexahedron", "tetrahedron"] = key("cells", '"hexahedron" or "tetrahedron"', default="hexahedron")
    order: Annotated[Literal[1, 2], BeforeValidator(_whole)] = key(
        "order of the cells and of the displacement", "1 or 2", default=2
    )
