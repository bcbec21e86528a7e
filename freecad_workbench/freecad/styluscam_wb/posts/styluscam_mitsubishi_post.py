# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_mitsubishi."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Mitsubishi = post_for("mitsubishi")
