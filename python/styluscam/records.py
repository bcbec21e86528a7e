"""Results with named fields that read as mappings too."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

from styluscam.types import Document


class Record(Mapping[str, Any]):
    """A result: ``finding.kind`` and ``finding["kind"]``, equal to the dict of its fields.

    Subclasses are frozen dataclasses with ``eq=False``: as mappings they compare by their items.
    """

    __slots__ = ()

    def __getitem__(self, key: str) -> Any:  # noqa: ANN401  # of the field's type
        """The field of that name."""
        if key in self._names():
            return getattr(self, key)
        raise KeyError(key)

    def __iter__(self) -> Iterator[str]:
        """The names of the fields."""
        return iter(self._names())

    def __len__(self) -> int:
        """How many fields."""
        return len(self._names())

    def to_dict(self) -> Document:
        """The fields as plain data, in their order; records in them too."""
        return {name: _plain(getattr(self, name)) for name in self._names()}

    @classmethod
    def _names(cls) -> tuple[str, ...]:
        return tuple(field.name for field in fields(cls))  # type: ignore[arg-type]  # subclasses are dataclasses


def plain(value: object) -> Document:
    """For ``json.dumps(..., default=plain)``."""
    if isinstance(value, Record):
        return value.to_dict()
    raise TypeError(f"{type(value).__name__} is not JSON")


def _plain(value: object) -> object:
    if isinstance(value, Record):
        return value.to_dict()
    return [_plain(each) for each in value] if isinstance(value, tuple | list) else value
