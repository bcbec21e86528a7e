# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_fanuc."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Fanuc = post_for("fanuc")
