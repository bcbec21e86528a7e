"""Shaded axonometric drawings as SVG: triangles, lines and labels, the far ones first. Numpy is all it needs."""

from __future__ import annotations

from dataclasses import dataclass, field
from html import escape

import numpy as np

from styluscam.types import FloatArray, IntArray

WIDTH, HEIGHT, MARGIN = 1200, 800, 40
LIGHT = np.array([-0.35, -0.45, 0.82])


@dataclass(frozen=True)
class View:
    """Where the eye is: turned about Z, raised above the horizon, far away."""

    azimuth_deg: float = -60.0
    elevation_deg: float = 52.0

    def axes(self) -> FloatArray:
        """Rows: right, up and towards the eye, (3, 3)."""
        a, e = np.radians(self.azimuth_deg), np.radians(self.elevation_deg)
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        eye = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
        return np.stack([right, np.cross(eye, right), eye])


@dataclass
class Drawing:
    """Collects shapes in space and writes them as one SVG."""

    view: View = field(default_factory=View)
    _shapes: list[tuple[float, FloatArray, str]] = field(default_factory=list)
    _labels: list[tuple[FloatArray, str]] = field(default_factory=list)
    _captions: list[str] = field(default_factory=list)

    def triangles(self, vertices: FloatArray, triangles: IntArray, colour: tuple[int, int, int]) -> None:
        """Triangles that face the eye, shaded; (V, 3) mm, (T, 3)."""
        axes = self.view.axes()
        corners = vertices[triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        sizes = np.linalg.norm(normals, axis=1)
        seen = (normals @ axes[2] > 0) & (sizes > 0)
        corners, normals = corners[seen], normals[seen] / sizes[seen, None]
        brightness = 0.45 + 0.55 * np.clip(normals @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0)
        for triangle, bright in zip(corners @ axes.T, brightness, strict=True):
            fill = "#{:02x}{:02x}{:02x}".format(*(int(c * bright) for c in colour))
            # a hairline of the same colour closes the seams between neighbours
            self._add(triangle, "polygon", f'fill="{fill}" stroke="{fill}" stroke-width="0.6"', 0.0)

    def line(self, points: FloatArray, colour: str, width: float, *, lift: float = 0.0) -> None:
        """A polyline (N, 3) mm, cut into short pieces so that each finds its depth; ``lift`` mm nearer to the eye."""
        seen = points @ self.view.axes().T
        style = f'fill="none" stroke="{colour}" stroke-width="{width}" stroke-linecap="round" stroke-linejoin="round"'
        for start in range(0, len(seen) - 1, 6):
            self._add(seen[start : start + 7], "polyline", style, lift)

    def label(self, place: FloatArray, text: str) -> None:
        """A text at a place (3,) mm, over everything."""
        self._labels.append((np.asarray(place) @ self.view.axes().T, text))

    def caption(self, text: str) -> None:
        """A line below the drawing."""
        self._captions.append(text)

    def _add(self, seen: FloatArray, element: str, style: str, lift: float) -> None:
        self._shapes.append((float(seen[:, 2].mean()) + lift, seen[:, :2], f"<{element} {style} points="))

    def svg(self) -> str:
        """The drawing, fitted into 1200 x 800."""
        everything = np.concatenate([shape[1] for shape in self._shapes])
        low, high = everything.min(axis=0), everything.max(axis=0)
        bottom = MARGIN + 26 * len(self._captions)
        room = np.array([WIDTH - 2 * MARGIN, HEIGHT - MARGIN - bottom])
        scale = float((room / np.maximum(high - low, 1e-9)).min())
        shift = np.array([WIDTH / 2, (MARGIN + HEIGHT - bottom) / 2]) - scale * np.array([1, -1]) * (low + high) / 2

        def placed(points: FloatArray) -> FloatArray:
            return points[:, :2] * np.array([scale, -scale]) + shift

        lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
            'font-family="system-ui, sans-serif">',
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
        ]
        for _, points, opening in sorted(self._shapes, key=lambda shape: shape[0]):
            coordinates = " ".join(f"{x:.1f},{y:.1f}" for x, y in placed(points))
            lines.append(f'{opening}"{coordinates}"/>')
        lines += _labels([(placed(place[None, :])[0], text) for place, text in self._labels])
        for i, text in enumerate(self._captions):
            y = HEIGHT - bottom + 26 * (i + 1) + 4
            lines.append(
                f'<text x="{WIDTH / 2:.0f}" y="{y}" text-anchor="middle" font-size="19" fill="#334">{escape(text)}</text>'
            )
        return "\n".join([*lines, "</svg>", ""])


def _labels(labels: list[tuple[FloatArray, str]]) -> list[str]:
    """Texts on a light ground, moved down where they would cover one another."""
    taken: list[tuple[float, float, float]] = []
    lines: list[str] = []
    for (x, y), text in sorted(labels, key=lambda label: float(label[0][1])):
        width = 9.5 * len(text) + 10
        row = float(y)
        while any(abs(row - other_y) < 24 and abs(x - other_x) < (width + other) / 2 for other_x, other_y, other in taken):
            row += 6
        taken.append((float(x), row, width))
        lines.append(
            f'<rect x="{x - width / 2:.1f}" y="{row - 12:.1f}" width="{width:.1f}" height="22" rx="4" fill="#ffffff" '
            'fill-opacity="0.85" stroke="#556" stroke-width="0.6"/>'
            f'<text x="{x:.1f}" y="{row + 5:.1f}" text-anchor="middle" font-size="16" fill="#112">{escape(text)}</text>'
        )
    return lines
