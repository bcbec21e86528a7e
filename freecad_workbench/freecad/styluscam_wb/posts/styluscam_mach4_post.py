# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_mach4."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Mach4 = post_for("mach4")
