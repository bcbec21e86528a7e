"""What the engine did to a mesh file's triangles to make a part of them, and the sentences on it."""

from __future__ import annotations

from dataclasses import dataclass

from styluscam.words import counted, position


@dataclass(frozen=True, slots=True)
class Filled:
    """Holes that were closed in what is a body but for them.

    Attributes:
        holes: how many.
        triangles: what they were closed with.
        widest: diagonal of the largest one's box, mm.
        at: the middle of that box, mm.
    """

    holes: int
    triangles: int
    widest: float
    at: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Mending:
    """What was done to a file's triangles; counts are of triangles where nothing else is named.

    Attributes:
        joined: corners that were joined though they do not agree to the last bit.
        join_distance: within what distance corners are joined, mm.
        moved: how far a corner moved at most, mm.
        degenerate: without area: left out.
        cut: cuts at corners of other triangles.
        duplicate: left out because the file has them more than once.
        back_to_back: left out between bodies that touch.
        double_sided: left out: the second side of a surface.
        turned: turned over because their neighbours wind oppositely.
        inside_out: turned over with their whole body.
        filled: holes that were closed; None where there are none.
        closed: whether each edge is shared by two triangles.
        unclear: a point where the triangles cannot be made to agree, mm; None where there is none.
    """

    joined: int
    join_distance: float
    moved: float
    degenerate: int
    cut: int
    duplicate: int
    back_to_back: int
    double_sided: int
    turned: int
    inside_out: int
    filled: Filled | None
    closed: bool
    unclear: tuple[float, float, float] | None

    def notes(self, triangles: int) -> tuple[str, ...]:
        """Return sentences on what was done, to a mesh that has ``triangles`` now."""
        done = (
            (self.joined, self._joined()),
            (self.degenerate, f"{_some(self.degenerate)} without area left out"),
            (self.cut, f"corners on sides of other triangles: those were cut there, {counted(self.cut, 'cut')}"),
            (self.duplicate, f"{_some(self.duplicate)} left out that the file has more than once"),
            (
                self.back_to_back,
                f"{_some(self.back_to_back)} left out back to back between bodies that touch: the bodies are one",
            ),
            (
                self.double_sided,
                f"the file has both sides of a surface: {_some(self.double_sided)} of the second side left out; where the "
                "surface encloses nothing, its material side is a guess (below)",
            ),
            (self.turned, f"{_some(self.turned)} turned over that wound against their neighbours"),
        )
        notes = [sentence for count, sentence in done if count]
        if self.inside_out == triangles:
            notes.append("the mesh was wound inward (inside out): its triangles were turned over")
        elif self.inside_out:
            notes.append(f"{_some(self.inside_out)} turned over, of bodies that were wound inward (inside out)")
        if self.filled is not None:
            filled = self.filled
            notes.append(
                f"the surface had {counted(filled.holes, 'hole')}, {filled.widest:.3g} mm wide at most, at "
                f"{position(filled.at)}: closed with {_some(filled.triangles)}; repair the part where an opening was meant"
            )
        if not self.closed:
            notes.append(
                "the mesh is open (not each edge is shared by two triangles): repair it if the part is a solid"
            )
        return tuple(notes)

    def _joined(self) -> str:
        return (
            f"{counted(self.joined, 'corner')} that did not quite meet others joined them, {self.moved:.2g} mm away at most "
            f"(corners within {self.join_distance:.2g} mm are joined)"
        )


def _some(triangles: int) -> str:
    return counted(triangles, "triangle")
