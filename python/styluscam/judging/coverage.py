"""What a program covers of a part, of all faces together and in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from styluscam.types import Document
from styluscam.words import place

SHOWN = 6
"""Faces that are told one by one: of more, those of which most is not covered."""

LEAST_AREA = 0.05
"""mm^2: areas are shown with one decimal."""


@dataclass(frozen=True)
class Totals:
    """Areas of all faces, mm^2."""

    formed: float
    """What the tool must touch."""
    covered: float
    """What of it is covered."""
    flat: float
    """What lies where the blank lies, and needs no forming."""
    carried: float
    """What goes down flat with the passes around it, and needs none either."""

    @classmethod
    def of(cls, faces: Sequence[Document]) -> Totals:
        """Sums up what ``Report.coverage`` gives."""
        areas = [float(face["area"]) for face in faces]
        formed = [to_form(face) for face in faces]
        return cls(
            sum(formed),
            sum(float(face["covered"]) * area for face, area in zip(faces, formed, strict=True)),
            sum(float(face["flat"]) * area for face, area in zip(faces, areas, strict=True)),
            sum(float(face["carried"]) * area for face, area in zip(faces, areas, strict=True)),
        )

    @property
    def share(self) -> float | None:
        """Of what must be touched, the share that is covered; none where nothing must be."""
        return self.covered / self.formed if self.formed >= LEAST_AREA else None


def to_form(face: Document) -> float:
    """The area of a face that the tool must touch, mm^2."""
    return float(face["area"]) * max(0.0, 1.0 - float(face["flat"]) - float(face["carried"]))


def lines(faces: Sequence[Document]) -> list[str]:
    """All faces together, then one by one."""
    told = [face for face in faces if to_form(face) >= LEAST_AREA]
    if len(told) > SHOWN:
        told = sorted(told, key=lambda face: (face["covered"] - 1.0) * to_form(face))[:SHOWN]
        told.sort(key=lambda face: int(face["face"]))
    hidden = sum(to_form(face) >= LEAST_AREA for face in faces) - len(told)
    more = [f"and {hidden} more faces of which less is left: --json has them all"] if hidden else []
    return [_of_all(Totals.of(faces)), *(_of_face(face) for face in told), *more]


def _of_all(totals: Totals) -> str:
    share = totals.share
    if share is None:
        told = "nothing must be touched"
    else:
        told = f"{100 * share:.1f} % of the {totals.formed:.1f} mm2 that the tool must touch"
    return told + "".join(f"; {area:.1f} mm2 need no forming: {why}" for area, why in unformed(totals))


def unformed(totals: Totals) -> list[tuple[float, str]]:
    """Areas that need no forming, mm^2, and why."""
    reasons = [
        (totals.flat, "the blank lies there"),
        (totals.carried, "flat, they go down with the passes around them"),
    ]
    return [(area, why) for area, why in reasons if area >= LEAST_AREA]


def _of_face(face: Document) -> str:
    most = "nothing touches it" if face["left"] is None else f"most left {face['left']:.3f} mm at {place(face['at'])}"
    scallop = f"scallop {face['scallop']:.4f} mm (mean {face['mean']:.4f}), " if face["covered"] > 0.0 else ""
    return f"Face{face['face']}: {100 * face['covered']:.1f} % of {to_form(face):.1f} mm2, {scallop}{most}"
