# SPDX-License-Identifier: LGPL-2.1-or-later
"""The class that documents of FreeCAD 1.0 name for a stylus: what it is in the FreeCAD that opens them."""

from __future__ import annotations

from . import compat

StylusBit = compat.toolbit_class()
