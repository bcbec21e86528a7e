"""The families of controllers, and what a reader of their texts reports when one of them would stop."""

from __future__ import annotations

from typing import Literal, TypeAlias

Family: TypeAlias = Literal["linuxcnc", "grbl", "fanuc", "okuma", "marlin", "siemens", "heidenhain"]

FAMILIES: tuple[Family, ...] = ("linuxcnc", "grbl", "fanuc", "okuma", "marlin", "siemens", "heidenhain")
RAPID_RATE: dict[Family, float] = {
    "linuxcnc": 3000.0,
    "grbl": 1000.0,
    "fanuc": 10000.0,
    "okuma": 10000.0,
    "marlin": 3000.0,
    "siemens": 10000.0,
    "heidenhain": 10000.0,
}
"""mm/min, as the shipped machine files assume."""
ARC_ERROR: dict[Family, float] = {
    "linuxcnc": 0.0283,
    "grbl": 0.005,
    "fanuc": 0.002,
    "okuma": 0.02,
    "siemens": 0.002,
    "heidenhain": 0.016,
}
"""How far an arc's radii may differ, mm; with LinuxCNC and GRBL a thousandth of the radius too, with Marlin all they like.

Fanuc's parameter 3410 and Siemens' MD21000 are the builder's: the least of what is usual is asked for.
"""
ENDLESS: tuple[Family, ...] = ("grbl", "marlin")
"""Families whose texts may end without a word that states so."""
ONE_TOOL: tuple[Family, ...] = ("grbl", "marlin")
"""Families that do not change tools."""
REPEATS: tuple[Family, ...] = ("marlin", "heidenhain")
"""Families that say the motion on each line."""


CYCLE = "a canned cycle is not read here"


class Refused(Exception):
    """What the controller would not take."""
