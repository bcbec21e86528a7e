"""What operations that clear stock engage and remove along their feed moves, measured from a text by the verifier."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from styluscam.records import Record
from styluscam.types import FloatArray, IntArray

KINDS = np.array(["cut", "link", "entry"])
"""Of moves, by the engine's codes."""


@dataclass(frozen=True, slots=True, eq=False)
class ClearedLayer(Record):
    """A layer of stock that an operation clears. Lengths mm.

    Attributes:
        top: its height.
        floor: height of the tip.
        radius: the tool's, at the layer's top.
        reference_rate: what a straight pass at the largest angle removes at the feed of the passes, mm^3/min.
    """

    top: float
    floor: float
    radius: float
    reference_rate: float


@dataclass(frozen=True, slots=True, eq=False)
class ClearingMoves(Record):
    """The feed moves of an operation that clears stock, in the order of the text; (M,) each. Lengths mm.

    Attributes:
        lines: of the text, from 1.
        layers: index of the layer.
        kinds: ``"cut"``; ``"link"`` through what is cleared; ``"entry"`` down into the material, where the bound does not hold.
        starts: length of the operation's feed moves up to the move's start, and ends: up to its end.
        feeds: mm/min; nan where the text states none per minute.
        roundings: what rounding the text's coordinates may have added to the stepover.
    """

    lines: IntArray
    layers: IntArray
    kinds: npt.NDArray[np.str_]
    starts: FloatArray
    ends: FloatArray
    feeds: FloatArray
    roundings: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class EntryFigures(Record):
    """An entry into the material, on which the bound of the engagement angle does not hold. Lengths mm.

    Attributes:
        first_line, last_line: of the text, from 1.
        start: length of the operation's feed moves up to there, and length: its own.
        max_deg: the largest angle on it.
    """

    first_line: int
    last_line: int
    start: float
    length: float
    max_deg: float


@dataclass(frozen=True, slots=True, eq=False)
class Largest(Record):
    """The largest value along an operation's feed moves.

    Attributes:
        value: in degrees, or mm^3/min.
        share: of the bound, or of the reference.
        line: of the text, from 1.
        distance: length of the operation's feed moves up to there, mm.
        position: the tool's tip, work coordinates, mm.
    """

    value: float
    share: float
    line: int
    distance: float
    position: list[float]


@dataclass(frozen=True, slots=True, eq=False)
class EngagementFigures(Record):
    """:class:`OperationEngagement` in figures. Lengths mm.

    Attributes:
        operation: its id.
        bound_deg: the largest engagement angle that it may have, but on entries.
        length: of its feed moves.
        layers: from the top down.
        angle: the largest, but on entries; None where nothing was measured.
        rate: the largest, but on entries; None where no move states a feed per minute.
        exempt: the entries on which the bound does not hold.
    """

    operation: str
    bound_deg: float
    length: float
    layers: list[ClearedLayer]
    angle: Largest | None
    rate: Largest | None
    exempt: list[EntryFigures]


@dataclass(frozen=True, slots=True, eq=False)
class OperationEngagement(Record):
    """What an operation that clears stock engages and removes along its feed moves. Lengths mm.

    Attributes:
        operation: its id.
        bound_deg: the largest engagement angle that it may have, but on entries.
        length: of all its feed moves; those over the stock, straight up, and below the last layer are not measured.
        layers: L, from the top down.
        moves: M.
        of_move: (N,), the move of each position, index.
        distances: (N,), length of the feed moves up to there.
        points: (N, 3), the tool's tip, work coordinates.
        angles_deg: (N,), the engagement angle.
        stepovers: (N,), area cleared per length of the path just under the layer's top: the radial stepover.
    """

    operation: str
    bound_deg: float
    length: float
    layers: list[ClearedLayer]
    moves: ClearingMoves
    of_move: IntArray
    distances: FloatArray
    points: FloatArray
    angles_deg: FloatArray
    stepovers: FloatArray

    @property
    def is_exempt(self) -> npt.NDArray[np.bool_]:
        """Whether the bound does not hold at a position, (N,): on entries."""
        return np.asarray(self.moves.kinds == "entry")[self.of_move]

    @property
    def reference_rates(self) -> FloatArray:
        """The reference of the layer of each position, (N,), mm^3/min."""
        return np.array([layer.reference_rate for layer in self.layers])[self.moves.layers[self.of_move]]

    @property
    def rates(self) -> FloatArray:
        """Volume removed in a minute, (N,), mm^3/min: the layer's depth times stepover times feed; nan on entries.

        There the tool takes the layer's depth little by little. What rounding may have added to the stepover is taken off: it
        matters on moves that are shorter than some hundredths of a millimetre.
        """
        depths = np.array([layer.top - layer.floor for layer in self.layers])[self.moves.layers]
        widths = np.maximum(self.stepovers - self.moves.roundings[self.of_move], 0.0)
        return np.where(self.is_exempt, np.nan, (depths * self.moves.feeds)[self.of_move] * widths)

    @property
    def bounded_deg(self) -> FloatArray:
        """The angles that the bound holds for, (N,), degrees: nan on entries.

        What rounding may have turned the heading by is taken off, as in the finding: it matters on moves that are shorter
        than some tenths of a millimetre.
        """
        radii = np.array([layer.radius for layer in self.layers])[self.moves.layers]
        turned = np.degrees(self.moves.roundings / radii)[self.of_move]
        return np.where(self.is_exempt, np.nan, np.maximum(self.angles_deg - turned, 0.0))

    @property
    def figures(self) -> EngagementFigures:
        """The largest angle, the largest rate, and the entries on which the bound does not hold."""
        bounded = self.bounded_deg
        return EngagementFigures(
            operation=self.operation,
            bound_deg=self.bound_deg,
            length=self.length,
            layers=self.layers,
            angle=self._largest(bounded, bounded / self.bound_deg),
            rate=self._largest(self.rates, self.rates / self.reference_rates),
            exempt=self.exempt,
        )

    def _largest(self, values: FloatArray, shares: FloatArray) -> Largest | None:
        """By its share; none where all are nan."""
        if not np.isfinite(shares).any():
            return None
        at = int(np.nanargmax(shares))
        return Largest(
            value=float(values[at]),
            share=float(shares[at]),
            line=int(self.moves.lines[self.of_move[at]]),
            distance=float(self.distances[at]),
            position=[float(x) for x in self.points[at]],
        )

    @property
    def exempt(self) -> list[EntryFigures]:
        """The entries that engage something, on which the bound does not hold, in the order of the text."""
        is_entry = np.concatenate([[False], self.moves.kinds == "entry", [False]])
        firsts, behind = np.flatnonzero(is_entry[1:] & ~is_entry[:-1]), np.flatnonzero(~is_entry[1:] & is_entry[:-1])
        entries = [self._exempt(int(first), int(end) - 1) for first, end in zip(firsts, behind, strict=True)]
        return [entry for entry in entries if entry.max_deg > 0.0]

    def _exempt(self, first: int, last: int) -> EntryFigures:
        moves, (low, high) = self.moves, np.searchsorted(self.of_move, [first, last + 1])
        return EntryFigures(
            first_line=int(moves.lines[first]),
            last_line=int(moves.lines[last]),
            start=float(moves.starts[first]),
            length=float(moves.ends[last] - moves.starts[first]),
            max_deg=float(self.angles_deg[low:high].max(initial=0.0)),
        )


Arrays: TypeAlias = "tuple[str, float, float, FloatArray, FloatArray, npt.NDArray[np.uint32], FloatArray]"
"""An operation's engagement as the engine hands it over."""


def of_arrays(arrays: Arrays) -> OperationEngagement:
    """The engine's arrays as records."""
    operation, bound, length, layers, numbers, codes, positions = arrays
    lines, layer, kind, counts = codes.astype(np.int64).T
    starts, ends, feeds, roundings = numbers.T
    return OperationEngagement(
        operation=operation,
        bound_deg=float(np.degrees(bound)),
        length=length,
        layers=[ClearedLayer(*map(float, row)) for row in layers],
        moves=ClearingMoves(lines, layer, KINDS[kind], starts, ends, feeds, roundings),
        of_move=np.repeat(np.arange(len(counts)), counts),
        distances=positions[:, 0],
        points=positions[:, 1:4],
        angles_deg=np.degrees(positions[:, 4]) + 0.0,  # never -0
        stepovers=positions[:, 5],
    )


def lines(found: list[OperationEngagement]) -> list[str]:
    """Each operation in a sentence."""
    return [_sentence(one.figures) for one in found]


def _sentence(figures: EngagementFigures) -> str:
    if figures.angle is None:
        return f"{figures.operation}: no cutting move to measure"
    sentence = (
        f"{figures.operation}: {figures.angle.value:.2f} of {figures.bound_deg:g} degrees (line {figures.angle.line})"
    )
    if figures.rate is None:
        return sentence
    return f"{sentence}, {100.0 * figures.rate.share:.1f} % of the reference removal rate (line {figures.rate.line})"
