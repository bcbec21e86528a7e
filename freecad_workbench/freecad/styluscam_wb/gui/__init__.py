# SPDX-License-Identifier: LGPL-2.1-or-later
"""What needs a window: workbench, commands, panels, pictures. Nothing outside this package imports it but `init_gui`."""
