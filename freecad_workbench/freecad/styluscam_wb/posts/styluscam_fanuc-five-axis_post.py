# SPDX-License-Identifier: LGPL-2.1-or-later
# ruff: noqa: N999 - named as the machine is
"""The post that FreeCAD lists as styluscam_fanuc-five-axis."""

from freecad.styluscam_wb.posts.processor import post_for

globals()["Styluscam_Fanuc-Five-Axis"] = post_for("fanuc-five-axis")
