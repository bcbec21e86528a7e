"""Plots of what the side of a leaning tool leaves of ruled surfaces, and the same for the maps of the part."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from styluscam.drawing.toolplot import SOFT
from styluscam.judging.flanks import FlankSurface, OperationFlank
from styluscam.report.plots import Plot, drawn
from styluscam.types import Document, FloatArray, IntArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEAST_UM = 1.0
"""Where the scale of errors ends at least."""

ROWS = 4_000_000
"""Distances that are held at once."""


def surfaces(found: OperationFlank, documents: list[Document]) -> list[Plot]:
    """The error map of each of an operation's surfaces; ``documents`` are the surfaces as the verifier's report has them."""
    return [
        Plot(f"{surface.name}: error along the normals", _map(surface), notes=(_note(surface, document, found),))
        for surface, document in zip(found.faces, documents, strict=True)
    ]


def left_on(points: FloatArray, faces: IntArray, triangles: IntArray, flanks: list[OperationFlank]) -> FloatArray:
    """What is left at points (N, 3) of faces that are milled with the side of a tool, mm; NaN elsewhere.

    ``faces`` (T,) are those of the ``triangles`` (T, 3). It is the value at the nearest position that was measured.
    """
    left = np.full(len(points), np.nan)
    for surface in (surface for flank in flanks for surface in flank.faces):
        number = face_of(surface)
        own = np.unique(triangles[faces == number]) if number is not None else np.zeros(0, dtype=np.int64)
        known = surface.points.reshape(-1, 3)
        values = surface.left.reshape(-1)
        step = max(1, ROWS // len(known))
        for start in range(0, len(own), step):
            some = own[start : start + step]
            apart = np.einsum("nij->ni", (points[some][:, None] - known[None]) ** 2)
            left[some] = values[np.argmin(apart, axis=1)]
    return left


def face_of(surface: FlankSurface) -> int | None:
    """The number of the face that a surface is; none between stated rails."""
    number = surface.name.removeprefix("Face")
    return int(number) if number.isdigit() else None


def _map(surface: FlankSurface) -> str:
    errors = 1e3 * np.where(np.isfinite(surface.left), surface.left, np.nan).T
    most = max(LEAST_UM, float(np.nanmax(np.abs(errors), initial=0.0)))

    def draw(axes: Axes) -> None:
        from matplotlib import colormaps

        colours = colormaps["RdBu"].copy()
        colours.set_bad(SOFT)
        image = axes.imshow(
            errors, origin="lower", aspect="auto", extent=(0, 100, 0, 100), cmap=colours, vmin=-most, vmax=most
        )
        axes.grid(visible=False)
        axes.set_xlabel("along the surface, %")
        axes.set_ylabel("up the ruling, %")
        bar = axes.figure.colorbar(image, ax=axes, pad=0.02)
        bar.set_label("entered   µm   left")

    return drawn(draw)


def _note(surface: FlankSurface, document: Document, found: OperationFlank) -> str:
    def where(key: str) -> str:
        at = document[key]
        return "" if at is None else f" (line {at['line']})"

    missed = f" The tool does not come over {100.0 * surface.missed:.2f} % of it." if surface.missed > 0.0 else ""
    return (
        f"The moving tool enters it by {1e3 * surface.over:.2f} µm at most{where('over_at')} and leaves"
        f" {1e3 * surface.under:.2f} µm at most{where('under_at')}.{missed} The axis turns by {found.speed_max:.1f} °/s at most."
    )
