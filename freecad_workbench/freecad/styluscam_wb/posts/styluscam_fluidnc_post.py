# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_fluidnc."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Fluidnc = post_for("fluidnc")
