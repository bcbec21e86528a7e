"""What a program covers of a part, of all faces together and in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from styluscam.judging.results import FaceCoverage
from styluscam.words import position

SHOWN = 6
"""Faces that are listed one by one: of more, those of which most is not covered."""

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
    def of(cls, faces: Sequence[FaceCoverage]) -> Totals:
        """Sums up what ``Report.coverage`` gives."""
        return cls(
            sum(face.to_form for face in faces),
            sum(face.covered * face.to_form for face in faces),
            sum(face.flat * face.area for face in faces),
            sum(face.carried * face.area for face in faces),
        )

    @property
    def share(self) -> float | None:
        """Of what must be touched, the share that is covered; none where nothing must be."""
        return self.covered / self.formed if self.formed >= LEAST_AREA else None


def lines(faces: Sequence[FaceCoverage]) -> list[str]:
    """All faces together, then one by one."""
    listed = [face for face in faces if face.to_form >= LEAST_AREA]
    if len(listed) > SHOWN:
        listed = sorted(listed, key=lambda face: (face.covered - 1.0) * face.to_form)[:SHOWN]
        listed.sort(key=lambda face: face.face)
    hidden = sum(face.to_form >= LEAST_AREA for face in faces) - len(listed)
    more = [f"and {hidden} more faces of which less is left: --json has them all"] if hidden else []
    return [_of_all(Totals.of(faces)), *(_of_face(face) for face in listed), *more]


def _of_all(totals: Totals) -> str:
    share = totals.share
    if share is None:
        text = "nothing must be touched"
    else:
        text = f"{100 * share:.1f} % of the {totals.formed:.1f} mm2 that the tool must touch"
    return text + "".join(f"; {area:.1f} mm2 need no forming: {why}" for area, why in unformed(totals))


def unformed(totals: Totals) -> list[tuple[float, str]]:
    """Areas that need no forming, mm^2, and why."""
    reasons = [
        (totals.flat, "the blank lies there"),
        (totals.carried, "flat, they go down with the passes around them"),
    ]
    return [(area, why) for area, why in reasons if area >= LEAST_AREA]


def _of_face(face: FaceCoverage) -> str:
    most = "nothing touches it"
    if face.left is not None and face.at is not None:
        most = f"most left {face.left:.3f} mm at {position(face.at)}"
    scallop = f"scallop {face.scallop:.4f} mm (mean {face.mean:.4f}), " if face.covered > 0.0 else ""
    return f"Face{face.face}: {100 * face.covered:.1f} % of {face.to_form:.1f} mm2, {scallop}{most}"
