"""Seeded defects of posted text: one function per kind, each of which spoils one thing as people and programs do.

A function takes the text and a random generator, and gives the spoilt text, or nothing where the text has no line for
it. Which lines matter is not asked here (`matters` decides it), but none is chosen that cannot.
"""

from __future__ import annotations

import defects_of_dialects as _dialects  # noqa: F401  # they register their kinds
import defects_of_moves as _moves  # noqa: F401
import defects_of_words as _words  # noqa: F401
from spoiling import FAMILIES_OF, KINDS, Text

__all__ = ["FAMILIES_OF", "KINDS", "Text"]
