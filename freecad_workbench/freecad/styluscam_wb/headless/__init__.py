# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents computed, verified and posted without a window: what `styluscam freecad run` asks of FreeCAD.

`run.run` takes a request and returns a report, both plain data. Nothing is written here: the texts are in the report.
"""
