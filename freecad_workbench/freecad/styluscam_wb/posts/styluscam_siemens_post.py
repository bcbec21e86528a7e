# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_siemens."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Siemens = post_for("siemens")
