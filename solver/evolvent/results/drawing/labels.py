"""Names of figures and of keys in words, with their units, which stand in the names."""

from __future__ import annotations

UNITS = {
    "_N_per_mm_um": "N/(mm·µm)", "_N_per_um": "N/µm", "_N_s_per_mm": "N·s/mm", "_mm2_per_N": "mm²/N",
    "_mm_per_rad": "mm/rad", "_mm_per_s": "mm/s", "_kg_m2": "kg·m²", "_kg": "kg", "_rpm": "r/min", "_Nm": "N·m",
    "_N": "N", "_MPa": "MPa", "_GPa": "GPa", "_um": "µm", "_mm3": "mm³", "_mm": "mm", "_deg": "°", "_percent": "%",
    "_MB": "MB", "_W": "W", "_Hz": "Hz", "_ms": "ms", "_s": "s",
}
"""Ending of a name -> unit."""

SYMBOLS = {"face_load_factor": "K_Hβ"}
"""Name of a figure -> symbol that stands behind it."""


def ending(name: str) -> str:
    """Unit at the end of a name, as it is written there; empty where there is none."""
    return next((each for each in UNITS if name.endswith(each)), "")


def label(name: str, unit: bool = True) -> str:
    """A name in words: "max_pressure_MPa" -> "max pressure [MPa]". Of the section of a key only the gear's stays.
    unit: with it."""
    last = ending(name)
    section, _, own = name.removesuffix(last).rpartition(".")
    gear = section if section in ("pinion", "wheel") else ""
    words = f"{gear} {own.replace('_', ' ')} {SYMBOLS.get(own, '')}".strip()
    return f"{words} [{UNITS[last]}]" if unit and last else words


def heading(words: str) -> str:
    """Words as a title: the first letter is a capital."""
    return words[:1].upper() + words[1:]
