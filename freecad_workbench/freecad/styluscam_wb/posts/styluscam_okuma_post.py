# SPDX-License-Identifier: LGPL-2.1-or-later
"""The post that FreeCAD lists as styluscam_okuma."""

from freecad.styluscam_wb.posts.processor import post_for

Styluscam_Okuma = post_for("okuma")
