# SPDX-License-Identifier: LGPL-2.1-or-later
"""StylusCAM in FreeCAD's CAM workbench: stylus tool bits, operations and posts over the styluscam engine.

`init` is imported at every start of FreeCAD, with and without a window; `init_gui`, when there is one, only with a
window. Nothing here imports the engine before a shape, a tool or a path is computed: documents open without it.
"""
