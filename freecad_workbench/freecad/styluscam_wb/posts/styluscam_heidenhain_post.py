# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_heidenhain."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Heidenhain = post_for("heidenhain")
