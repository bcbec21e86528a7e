# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_uccnc."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Uccnc = post_for("uccnc")
