"""Units at the ends of keys, and the conversion of a value from one to another."""

from __future__ import annotations

import math
import re

UNITS: dict[str, tuple[str, float]] = {
    "mm": ("length", 1.0), "um": ("length", 1e-3), "m": ("length", 1e3), "cm": ("length", 10.0),
    "in": ("length", 25.4), "inch": ("length", 25.4), "inches": ("length", 25.4), "mil": ("length", 0.0254),
    "mils": ("length", 0.0254), "thou": ("length", 0.0254), "micron": ("length", 1e-3), "microns": ("length", 1e-3),
    "deg": ("angle", 1.0), "rad": ("angle", 180.0 / math.pi), "degree": ("angle", 1.0), "degrees": ("angle", 1.0),
    "Nm": ("moment", 1.0), "Nmm": ("moment", 1e-3), "kNm": ("moment", 1e3), "lbin": ("moment", 0.1129848),
    "lbf_in": ("moment", 0.1129848), "in_lbf": ("moment", 0.1129848), "in_lb": ("moment", 0.1129848),
    "lb_in": ("moment", 0.1129848), "lbf_ft": ("moment", 1.355818), "ft_lbf": ("moment", 1.355818),
    "ft_lb": ("moment", 1.355818), "lb_ft": ("moment", 1.355818),
    "GPa": ("stress", 1e9), "MPa": ("stress", 1e6), "kPa": ("stress", 1e3), "Pa": ("stress", 1.0),
    "N_mm2": ("stress", 1e6), "psi": ("stress", 6894.757), "ksi": ("stress", 6.894757e6), "Msi": ("stress", 6.894757e9),
    "rpm": ("speed", 1.0), "rad_s": ("speed", 30.0 / math.pi), "rps": ("speed", 60.0),
    "kg_m2": ("inertia", 1.0), "kgm2": ("inertia", 1.0), "kgmm2": ("inertia", 1e-6),
    "kg_mm2": ("inertia", 1e-6), "kg_cm2": ("inertia", 1e-4),
    "lb_in2": ("inertia", 2.926397e-4), "t_mm2": ("inertia", 1e-3),
    "kg_m3": ("density", 1.0), "g_cm3": ("density", 1e3), "t_mm3": ("density", 1e12), "kg_mm3": ("density", 1e9),
    "lb_in3": ("density", 27679.9),
    "N_per_um": ("stiffness", 1.0), "N_per_mm": ("stiffness", 1e-3), "N_per_m": ("stiffness", 1e-6),
    "N_um": ("stiffness", 1.0), "N_m": ("stiffness", 1e-6), "lbf_per_in": ("stiffness", 1.751268e-4),
    "mm2_per_N": ("wear", 1.0), "m2_per_N": ("wear", 1e6), "mm3_per_Nm": ("wear", 1e-3), "per_Pa": ("wear", 1e6),
    "per_MPa": ("wear", 1.0), "N": ("force", 1.0), "kN": ("force", 1e3), "lbf": ("force", 4.448222),
    "kW": ("power", 1e3), "W": ("power", 1.0), "hp": ("power", 745.7), "s": ("time", 1.0), "h": ("time", 3600.0),
    "Hz": ("frequency", 1.0), "C": ("temperature", 1.0), "kg": ("mass", 1.0), "percent": ("share", 1.0),
}
"""Unit -> quantity, and its value in one of that quantity's units."""
ENDING = re.compile(rf"_({'|'.join(sorted(UNITS, key=len, reverse=True))})$", re.IGNORECASE)
SPELLED = {unit.lower(): unit for unit in reversed(UNITS)}
WORDS = {1e-9: "divide by 1e9", 180.0 / math.pi: "multiply by 180/π", 30.0 / math.pi: "multiply by 30/π"}


def unit_of(key: str) -> str:
    """The unit that ends a key; empty where there is none."""
    found = ENDING.search(key)
    return "" if found is None else found[1] if found[1] in UNITS else SPELLED[found[1].lower()]


def stem_of(key: str) -> str:
    """The last part of a dotted key in lower case, without its unit."""
    return ENDING.sub("", key.rpartition(".")[2]).lower()


def unit_conversion(name: str, meant: str) -> str:
    """Conversion of a value from the unit in the name of an unknown key to that of the key that was meant, in words.

    Empty where the two name the same unit, or one of them none that is known.
    """
    (quantity, given), (wanted, unit) = (UNITS.get(unit_of(each), ("", 1.0)) for each in (name, meant))
    if not quantity or quantity != wanted or given == unit:
        return ""
    ratio = given / unit
    if words := WORDS.get(ratio):
        return words
    divides = ratio < 1.0 and math.isclose(1.0 / ratio, round(1.0 / ratio))
    return f"divide by {1.0 / ratio:.7g}" if divides else f"multiply by {ratio:.7g}"


def are_of_one_quantity(name: str, meant: str) -> bool:
    """Whether an unknown key may hold the quantity of another one, by the units that end them: without a unit it may,
    with one only where that has one of the same quantity."""
    given, wanted = (UNITS.get(unit_of(each), ("", 1.0))[0] for each in (name, meant))
    return not given or given == wanted
