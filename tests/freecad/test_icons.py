"""The addon's icons: squares that are small files, and that stand out on light and on dark panels."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest
from freecad_host import ADDON

PACKAGE = ADDON / "freecad" / "styluscam_wb"
ICONS = PACKAGE / "resources" / "icons"
FILES = [*sorted(ICONS.rglob("*.svg")), PACKAGE / "resources" / "styluscam.svg"]

PANELS = ("#ffffff", "#2b2b2b")
"""The lightest panel, and that of FreeCAD's dark theme."""

LEAST_CONTRAST = 3.0
"""What WCAG 2.1 (1.4.11) asks of graphics."""

MOST_BYTES = 4096

DRAWN = ("path", "circle", "rect", "ellipse", "line", "polyline", "polygon")


def luminance(colour: str) -> float:
    """WCAG's relative luminance of #rrggbb."""
    parts = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one: str, other: str) -> float:
    """WCAG's ratio of contrast, 1 to 21."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def outlines(root: ElementTree.Element) -> Iterator[tuple[str, str | None]]:
    """The colour of each shape's outline: its stroke, where it has one, else what it is filled with."""
    for node in root.iter():
        if node.tag.rpartition("}")[2] not in DRAWN:
            continue
        stroke, fill = (node.get(name) or root.get(name) for name in ("stroke", "fill"))
        yield node.get("d") or str(node.attrib), stroke if stroke and stroke != "none" else fill


def test_contrast_is_that_of_wcag() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.005)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_an_icon_is_a_small_square(path: Path) -> None:
    root = ElementTree.fromstring(path.read_bytes())
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert root.get("width") == root.get("height") == "64" and root.get("viewBox") == "0 0 64 64"
    assert path.stat().st_size <= MOST_BYTES


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_an_icon_stands_out_on_both_panels(path: Path) -> None:
    """A shape inside another one may stand out less: it is the outermost shape that shows what the icon is."""
    found = list(outlines(ElementTree.fromstring(path.read_bytes())))
    assert found
    weak = [
        (colour, where) for where, colour in found if min(contrast(str(colour), p) for p in PANELS) < LEAST_CONTRAST
    ]
    inner = {"#f2c48d"} if path.stem == "heat-map" else set()  # the warm middle of the map lies on the blue
    assert {colour for colour, _ in weak} == inner


def named_icons() -> dict[str, str]:
    """The icon of each class of commands, from the sources."""
    found = {}
    for file in sorted((PACKAGE / "gui").glob("*.py")):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        constants = {
            line.targets[0].id: getattr(line.value, "value", None)
            for line in tree.body
            if isinstance(line, ast.Assign) and isinstance(line.targets[0], ast.Name)
        }
        for node in ast.walk(tree):
            if not isinstance(node, ast.ClassDef):
                continue
            for line in node.body:
                if isinstance(line, ast.Assign) and getattr(line.targets[0], "id", "") == "icon":
                    found[node.name] = getattr(line.value, "value", None) or constants[line.value.id]
    return found


def test_every_command_has_its_icon() -> None:
    named = named_icons()
    assert {"MakeJob", "Post", "Preferences"} <= set(named)
    assert {name: icon for name, icon in named.items() if not (ICONS / f"{icon}.svg").is_file()} == {}


def test_kinds_without_an_icon_of_their_own_have_one() -> None:
    assert (ICONS / "operation.svg").is_file()
