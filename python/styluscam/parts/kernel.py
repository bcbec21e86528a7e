"""The CAD kernel (OpenCASCADE through OCP): what it throws and prints, and the shapes of a kind in a shape."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

from styluscam.errors import GeometryError
from styluscam.extras import require

# An object of the CAD kernel, whose Python bindings have no types.
Kernel: TypeAlias = Any


def ocp(file: Path) -> None:
    """Import the CAD kernel, or report what to install."""
    what = f"{file}: reading {file.suffix} files"
    require("step", what, failure=GeometryError, code="part-extra-step", where=str(file))


@contextmanager
def quiet_kernel() -> Iterator[None]:
    """Take the kernel's message printers away for a while: it writes to stdout otherwise."""
    from OCP.Message import Message

    messenger = Message.DefaultMessenger_s()
    printers = list(messenger.Printers())
    for printer in printers:
        messenger.RemovePrinter(printer)
    try:
        yield
    finally:
        for printer in printers:
            messenger.AddPrinter(printer)


@cache
def thrown_by_kernel() -> tuple[type[Exception], ...]:
    """Every class of exceptions of the kernel: in Python none of them derives from another."""
    from OCP import Standard, StdFail

    classes = [*vars(Standard).values(), *vars(StdFail).values()]
    return tuple(cls for cls in classes if isinstance(cls, type) and issubclass(cls, Exception))


@contextmanager
def kernel_failures(file: Path) -> Iterator[None]:
    """Turn what the kernel throws into a sentence: its own words are names of its classes."""
    try:
        yield
    except thrown_by_kernel() as error:
        cure = "open the part in a CAD system, check its geometry there and export it again"
        raise GeometryError(
            f"{file}: the CAD kernel cannot process its geometry: {cure}",
            code="part-kernel",
            where=str(file),
            hint=cure,
        ) from error


def map_shapes(shape: Kernel, kind: str) -> Kernel:
    """Return the kernel's map of the shapes of a kind (``FACE``, ``SHELL``, ``SOLID``) in a shape."""
    from OCP import TopAbs, TopTools
    from OCP.TopExp import TopExp

    found = TopTools.TopTools_IndexedMapOfShape()
    if not shape.IsNull():
        TopExp.MapShapes_s(shape, getattr(TopAbs.TopAbs_ShapeEnum, f"TopAbs_{kind}"), found)
    return found


def count(shape: Kernel, kind: str) -> int:
    """Return how many shapes of a kind a shape holds."""
    return int(map_shapes(shape, kind).Size())


def faces_of(shape: Kernel) -> list[Kernel]:
    """Return the faces in TopExp order: the first is Face1 in FreeCAD."""
    from OCP.TopoDS import TopoDS

    found = map_shapes(shape, "FACE")
    return [TopoDS.Face_s(found.FindKey(i)) for i in range(1, found.Size() + 1)]


def xyz(value: Kernel) -> tuple[float, float, float]:
    """Return the coordinates of a point or vector of the kernel."""
    return (value.X(), value.Y(), value.Z())
