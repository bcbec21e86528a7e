# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posts for whole CAM jobs: one `styluscam_<machine>_post.py` for each shipped machine, found by FreeCAD here."""
