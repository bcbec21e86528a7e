"""Pictures of one job in the window, one after the other: each part is a scenario of its own on the same document."""

from __future__ import annotations

import sys
import traceback
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import driver
import FreeCADGui
import picture_stage as drawn
import stage
from driver import QtWidgets, until


def pressed(command: str) -> Any:
    """Presses a button of ours as soon as it can be pressed."""
    yield until(lambda: driver.tool_button(f"StylusCAM_{command}").isEnabled(), f"{command} enabled")
    driver.click(driver.tool_button(f"StylusCAM_{command}"))


def closed(which: Any = QtWidgets.QDialogButtonBox.Close) -> Any:
    """Closes the open panel by its button."""
    driver.click(driver.panel_button(which))
    yield until(stage.panel_is_closed, "a closed panel")


def opened(name: str) -> Any:
    """Waits for a panel."""
    yield until(lambda: driver.visible(QtWidgets.QWidget, name=name), f"the panel {name}", 90)
    yield driver.settled()


def path_in_colours(job: Any, operation: Any) -> Any:
    """Its segments with their colours, the legend, and what the command does."""
    from freecad.styluscam_wb.gui import path_colours

    view_object = operation.ViewObject
    material, points, lines = path_colours.drawn_lines(view_object)

    def seen() -> dict[str, Any]:
        return {
            "points": [point.getValue() for point in points.point.getValues()],
            "index": list(lines.coordIndex.getValues()),
            "colours": [colour.getValue() for colour in material.diffuseColor.getValues()],
            "legend": drawn.legend("path"),
        }

    def has_colours(count: int) -> Any:
        return until(lambda: len({tuple(colour) for colour in seen()["colours"]}) == count, f"{count} colours")

    yield has_colours(3)
    yield driver.settled()
    result = {"on": seen(), "shot": driver.shot("path")}
    yield from pressed("PathColours")
    yield has_colours(2)
    result["off"] = seen()
    yield from pressed("PathColours")
    yield has_colours(3)
    view_object.StartIndex, view_object.ShowCount = 2, 4
    yield until(lambda: len(lines.coordIndex.getValues()) < len(result["on"]["index"]), "a part of it")
    yield driver.settled(6)
    result["part"] = seen()
    view_object.StartIndex, view_object.ShowCount = 0, 0
    view_object.Visibility = False
    yield until(lambda: drawn.legend("path") is None, "no legend")
    view_object.Visibility = True
    yield until(lambda: drawn.legend("path") is not None, "a legend")
    return result


def sound(job: Any, operation: Any) -> Any:
    """The verification of a path as it was computed."""
    yield from pressed("Verify")
    yield from opened("StylusCAM_Findings")
    result = {**_findings(), "shot": driver.shot("sound")}
    yield from closed()
    return result


def heat_map(job: Any, operation: Any) -> Any:
    """Each map, its legend, and the engine's numbers where it is drawn; it stays after OK until the operation changes."""
    from freecad.styluscam_wb.gui import heat_colours

    yield from pressed("HeatMap")
    yield from opened("StylusCAM_HeatMaps")
    combo = driver.one(QtWidgets.QComboBox, name="HeatMap")
    titles = [combo.itemText(index) for index in range(combo.count())]
    result: dict[str, Any] = {"maps": {}, "scale": heat_colours.SCALE}
    for title in titles:
        driver.choose(combo, title)
        yield until(lambda wanted=title: wanted in (drawn.legend("heat") or ()), title)
        yield driver.settled()
        picture = driver.shot(f"heat-{titles.index(title)}")
        result["maps"][title] = {**drawn.map_seen(), "legend": drawn.legend("heat"), "shot": picture}
    result["left"] = drawn.left_at(job, result["maps"][titles[0]]["points"])
    result["model is drawn"] = drawn.is_drawn(job)
    yield from closed(QtWidgets.QDialogButtonBox.Ok)
    result["after OK"] = drawn.overlay("StylusCAM_HeatMap") is not None
    operation.touch()
    job.Document.recompute()
    yield until(lambda: drawn.overlay("StylusCAM_HeatMap") is None, "no map", 60)
    result["after a change"] = [drawn.legend("heat"), drawn.is_drawn(job)]
    return result


def contact_track(job: Any, operation: Any) -> Any:
    """Its points, how far each is from the model, and how it goes."""
    yield from pressed("ContactTrack")
    yield until(lambda: drawn.overlay("StylusCAM_ContactTrack"), "the track", 90)
    yield driver.settled()
    result = {**drawn.track_seen(job), "legend": drawn.legend("contacts"), "shot": driver.shot("contacts")}
    yield from pressed("ContactTrack")
    yield until(lambda: not drawn.overlay("StylusCAM_ContactTrack"), "no track")
    result["legend after"] = drawn.legend("contacts")
    return result


def sheet(job: Any, operation: Any) -> Any:
    """Blank and formed sheet instead of stock and model; gone with the command."""
    job.Stock.ViewObject.Visibility = True
    yield driver.settled()
    yield from pressed("Sheet")
    yield until(lambda: drawn.overlay("StylusCAM_Sheet"), "the sheet", 90)
    yield driver.settled()
    names = [obj.Name for obj in job.Document.Objects]
    result: dict[str, Any] = {"spif": drawn.sheet_seen(), "legend": drawn.legend("sheet"), "shot": driver.shot("sheet")}
    result["stock and model are drawn"] = [drawn.is_object_drawn(job.Stock), drawn.is_drawn(job)]
    yield from pressed("Sheet")
    yield until(lambda: not drawn.overlay("StylusCAM_Sheet"), "no sheet")
    result["after"] = [drawn.legend("sheet"), drawn.is_object_drawn(job.Stock), drawn.is_drawn(job)]
    result["objects"] = [len(names), len(job.Document.Objects)]
    job.Stock.ViewObject.Visibility = False
    return result


def moving_tool(job: Any, operation: Any) -> Any:
    """The tool at a position of the path by length, and played to its end."""
    yield from pressed("ToolMotion")
    yield from opened("StylusCAM_ToolMotion")
    value = driver.one(QtWidgets.QDoubleSpinBox, name="Value")
    result: dict[str, Any] = {"positions": drawn.positions(operation), "end by time": value.maximum()}
    driver.choose(driver.one(QtWidgets.QComboBox, name="Measure"), "by length, mm")
    yield until(lambda: value.maximum() != result["end by time"], "lengths")
    result["end by length"] = value.maximum()
    yield driver.focused(value)
    driver.write(value, "500")
    yield until(lambda: abs(value.value() - 500.0) < 1e-6, "500 mm")
    yield driver.settled()
    readout, slider = driver.one(QtWidgets.QLabel, name="Readout"), driver.one(QtWidgets.QSlider, name="Along")
    result |= {"tip": drawn.tip(), "readout": readout.text(), "box": drawn.tool_box(), "shot": driver.shot("tool")}
    result["slider"] = slider.value() / slider.maximum()
    speed = driver.one(QtWidgets.QSpinBox, name="Speed")
    yield driver.focused(speed)
    driver.write(speed, "1000")
    yield until(lambda: speed.value() == 1000, "the speed")
    play = driver.one(QtWidgets.QPushButton, name="Play")
    driver.click(play)
    yield until(play.isChecked, "a moving tool")
    yield until(lambda: not play.isChecked(), "the end", 30)
    result |= {"at the end": drawn.tip(), "text at the end": play.text()}
    yield from closed()
    result["after"] = drawn.overlay("StylusCAM_Tool") is not None
    return result


def simulators(job: Any, operation: Any) -> Any:
    """FreeCAD's own: the one that our command opens, and what both have for our tool and cut with it."""
    yield from pressed("Simulate")
    yield until(FreeCADGui.Control.activeDialog, "the panel of the simulator", 60)
    yield driver.settled()
    result: dict[str, Any] = {"listed": _listed_operations(), "shot": driver.shot("simulator")}
    yield from closed()
    lowest = min(at[2] for at in drawn.positions(operation))
    return result | {
        "profile": drawn.simulated_profile(operation),
        "cut": drawn.cut_by_voxels(job, operation),
        "path": lowest,
    }


def _listed_operations() -> list[str]:
    found = driver.one(QtWidgets.QListWidget, name="listOperations")
    return [found.item(row).text() for row in range(found.count())]


def report(job: Any, operation: Any) -> Any:
    """The page beside the saved document."""
    from freecad.styluscam_wb.gui import report_command

    job.Document.saveAs(str(driver.FOLDER / "cup.FCStd"))
    found: list[str] = []
    report_command.open_page = lambda path: found.append(str(path))  # there is no browser
    yield from pressed("Report")
    yield until(lambda: found, "a page", 90)
    yield driver.settled()
    return {"opened": found}


def spoilt(job: Any, operation: Any) -> Any:
    """The verification of a path that enters the model: the finding listed, and marked when it is selected."""
    at = drawn.pushed_down(operation, 0.3)
    yield from pressed("Verify")
    yield from opened("StylusCAM_Findings")
    tree = driver.one(QtWidgets.QTreeWidget, name="Findings")
    driver.click(tree.viewport(), tree.visualItemRect(tree.topLevelItem(0)).center())
    yield until(lambda: drawn.overlay("StylusCAM_Finding"), "the marker")
    yield driver.settled()
    result = {**_findings(), "at": at, "marker": drawn.marked(), "faces": drawn.selected_faces()}
    result |= {"centre": drawn.centre_of_view(), "shot": driver.shot("finding")}
    yield from closed()
    result["after"] = drawn.overlay("StylusCAM_Finding") is not None
    return result


def _findings() -> dict[str, Any]:
    panel = driver.one(QtWidgets.QWidget, name="StylusCAM_Findings")
    texts = {label.objectName(): label.text() for label in panel.findChildren(QtWidgets.QLabel)}
    tree = panel.findChild(QtWidgets.QTreeWidget)
    rows = [[tree.topLevelItem(i).text(k) for k in range(3)] for i in range(tree.topLevelItemCount())]
    return {"texts": texts, "rows": rows}


PARTS = {
    "path in colours": path_in_colours,
    "sound": sound,
    "heat map": heat_map,
    "contact track": contact_track,
    "sheet": sheet,
    "moving tool": moving_tool,
    "simulators": simulators,
    "report": report,
    "spoilt": spoilt,
}


def pictures() -> Any:
    """All of them; one that breaks leaves its traceback, and its panel is closed."""
    job, operation = drawn.formed_cup()
    yield from stage.workbench("StylusCamWorkbench")
    result: dict[str, Any] = {}
    for name, part in PARTS.items():
        try:
            result[name] = yield from part(job, operation)
        except Exception:
            result[name] = {"broke": traceback.format_exc(), "shot": driver.shot(f"broke-{name}")}
            if FreeCADGui.Control.activeDialog():
                FreeCADGui.Control.closeDialog()
    return result


driver.run({"pictures": pictures})
