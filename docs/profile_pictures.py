"""Draws the pictures of docs/profiles.md into docs/images: one of each kind, its options, and the comparison at its top.

.venv/bin/python docs/profile_pictures.py
"""

from __future__ import annotations

from pathlib import Path

from PIL import Image

import styluscam as sc
from styluscam.drawing.toolplot import tool_picture
from styluscam.tools import starters, toolfile

IMAGES = Path(__file__).parent / "images"

COLOURS = 48
"""Of a palette: enough for the lines' soft edges, and a picture of 20 kB."""

COMPARED = ("ball", "clothoid", "ellipse", "rounded-rectangle")

BALL = {"kind": "ball", "diameter": 12.0}

OPTIONS = {
    "part-circle": {"half a circle": {"profile": BALL}, "a part of a larger one": {"profile": {**BALL, "radius": 8.0}}},
    "tip-flat": {f"tip_flat = {flat:g}": {"profile": {**BALL, "tip_flat": flat}} for flat in (0.0, 1.0, 2.5)},
    "base": {
        kind: {
            "profile": {"kind": "clothoid", "diameter": 10.0},
            "base": {"kind": kind, "height": 5.0},
            "shank_diameter": 16.0,
            "length": 55.0,
            "holder": {"diameter": 34.0, "length": 30.0},
        }
        for kind in ("cylindrical", "chamfer", "tangent")
    },
}
"""Tools by their name, by picture."""


def draw(tools: list[sc.Tool], name: str) -> None:
    """A picture as `styluscam tool plot` draws it, with few colours."""
    path = IMAGES / f"profile-{name}.png"
    tool_picture(tools, path)
    with Image.open(path) as picture:
        small = picture.convert("RGB").quantize(COLOURS)
    small.save(path, optimize=True)


def main() -> None:
    """Draws them all."""
    known = starters.profiles()
    profiles = [BALL if kind == "ball" else known[kind] for kind in COMPARED]
    draw([sc.Tool.from_dict({"profile": profile}) for profile in profiles], "compared")
    for name, tools in OPTIONS.items():
        draw([sc.Tool.from_dict({"name": title, **tool}) for title, tool in tools.items()], name)
    for kind in toolfile.profile_keys():
        draw([sc.Tool.from_dict({"profile": known[kind]})], kind)


if __name__ == "__main__":
    main()
