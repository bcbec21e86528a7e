# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_masso."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Masso = post_for("masso")
