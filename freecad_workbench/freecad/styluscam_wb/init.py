# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start-up, with and without a window."""
