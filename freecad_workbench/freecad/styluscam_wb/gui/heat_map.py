# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command "Heat map": numbers of the verification in colours on the model, with a legend; the same as a report's page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import FreeCADGui
import numpy as np
from PySide import QtWidgets

from .. import verification
from ..long_work import Run, long_work
from ..verification import Verified
from . import heat_colours, legend, pictures, scene
from .command import Command
from .heat_colours import short
from .messages import translated
from .picture_command import PictureCommand

if TYPE_CHECKING:
    from styluscam.report.heatmaps import HeatMap, Shown

KEY = "heat"

POINTS = 60_000
"""Of the coloured model at most: a view that is turned redraws all of them, on any graphics card."""

BORDERS: scene.Colour = (0x3B, 0x47, 0x54)


class NoMapError(ValueError):
    """There is nothing to colour; the message states why."""

    hint = ""  # it stands in the message


@dataclass(frozen=True)
class Maps:
    """What can be shown of a verified job."""

    verified: Verified
    shown: Shown


def maps_of(job: Any, run: Run) -> Maps:
    """Verifies a job, and computes the numbers on its model as a report does; `run` runs what takes long.

    Raises:
        NoMapError: there are none.
        What `verification.verify_job` raises.
    """
    from styluscam.report.heatmaps import shown_judged

    verified = verification.verify_job(job, run)
    surface = verified.subject.surface
    if surface is None:
        raise NoMapError(f"{job.Label}: its verification has no part: there is nothing to colour")
    shown: Shown = run(lambda progress: shown_judged(surface, verified.report, progress, POINTS))
    if not shown.maps:
        raise NoMapError(f"{job.Label}: its report has no heat map")
    return Maps(verified, shown)


def show(maps: Maps, chosen_map: HeatMap) -> None:
    """Draws a map in place of the model."""
    job, shown = maps.verified.draft.job, maps.shown
    vertices = shown.vertices
    points = shown.points[vertices.at]
    nodes = scene.faces(points, vertices.triangles, vertices.normals, heat_colours.colours_of(chosen_map))
    borders = scene.separator("Borders", *scene.lines(shown.points, scene.between(shown.borders), BORDERS, 1.0))
    ends = _extremes(chosen_map)
    marks = [scene.marker(points[index]) for index in dict.fromkeys(ends.values())]
    node = scene.separator("StylusCAM_HeatMap", *nodes, borders, *marks)
    card = _card(chosen_map, {word: (index, points[index]) for word, index in ends.items()})
    pictures.show(pictures.Picture(job.Document.Name, KEY, node, card, pictures.stands_for(job)))


def _extremes(shown: HeatMap) -> dict[str, int]:
    """The vertices of the largest and the smallest number, by what the legend calls them; of equal ones the first."""
    known = np.flatnonzero(shown.values >= 0.0)
    if not len(known):
        return {}
    values = shown.values[known]
    largest, smallest = int(known[np.argmax(values)]), int(known[np.argmin(values)])
    found = {translated("largest"): largest}
    if shown.low > 0.0:  # where a scale does not begin at 0, its low end counts as well
        found[translated("smallest")] = smallest
    return found


def _card(shown: HeatMap, ends: dict[str, tuple[int, Any]]) -> legend.Card:
    card = legend.Card(KEY, f"{translated(shown.title)}, {shown.unit}")
    card.add_bar(heat_colours.SCALE, heat_colours.marks_of(shown))
    if shown.limit is not None:
        card.add_swatch(heat_colours.OVER, shown.over)
    if shown.unformed:
        card.add_swatch(heat_colours.UNFORMED, shown.unformed)
    for word, (index, point) in ends.items():
        value = shown.values[index]
        is_over = shown.limit is not None and value > shown.limit
        text = shown.over if is_over else f"{short(value)} {shown.unit}"
        x, y, z = point
        card.add_line(f"{word}: {text}\n{translated('at')} X {x:.3f} Y {y:.3f} Z {z:.3f}")
    if not ends:
        card.add_line(translated("nowhere"))
    return card


class MapPanel:
    """Chooses among the maps; the task view shows its `form`."""

    def __init__(self, maps: Maps) -> None:
        self._maps = maps
        self._job = maps.verified.draft.job
        self._document = str(self._job.Document.Name)
        self.form = QtWidgets.QWidget()
        self.form.setObjectName("StylusCAM_HeatMaps")
        self.form.setWindowTitle(translated("Heat map"))
        rows = QtWidgets.QVBoxLayout(self.form)
        self._choice = QtWidgets.QComboBox()
        self._choice.setObjectName("HeatMap")
        for one in maps.shown.maps:
            self._choice.addItem(f"{translated(one.title)}, {one.unit}")
        self._note = QtWidgets.QLabel()
        self._note.setObjectName("Note")
        self._note.setWordWrap(True)
        rows.addWidget(self._choice)
        rows.addWidget(self._note)
        rows.addStretch(1)
        self._choice.currentIndexChanged.connect(self._choose)
        self._choose(0)

    def _choose(self, index: int) -> None:
        one = self._maps.shown.maps[index]
        self._note.setText(one.note)
        if not pictures.is_deleted(self._job):  # without its job there is no model to colour
            show(self._maps, one)

    def getStandardButtons(self) -> Any:
        """OK keeps the map, Cancel takes it away."""
        return QtWidgets.QDialogButtonBox.Ok | QtWidgets.QDialogButtonBox.Cancel

    def accept(self) -> bool:
        """Closes the panel; the map stays until the command, or a change of the operation, takes it away."""
        FreeCADGui.Control.closeDialog()
        return True

    def reject(self) -> bool:
        """Closes the panel and takes the map away."""
        pictures.remove(self._document, KEY)
        FreeCADGui.Control.closeDialog()
        return True


class ShowHeatMap(PictureCommand):
    """Verifies the job in front and colours its model; takes the colours away where they are shown."""

    key = KEY
    name = "HeatMap"
    icon = "heat-map"
    menu_text = "Heat map"
    tool_tip = "Colours the model by what the job leaves on it, gouges, wall angle or thickness; again to take it away"

    def draw(self, job: Any) -> None:
        """Verifies, then opens the panel that draws."""
        with long_work(f"{job.Label}: heat map") as work:
            maps = maps_of(job, work)
        FreeCADGui.Control.showDialog(MapPanel(maps))


def commands() -> list[Command]:
    """The command."""
    return [ShowHeatMap()]
