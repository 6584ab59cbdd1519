"""A table as data: written as Markdown for people and as JSON for programs."""

from collections.abc import Sequence
from typing import Any, NamedTuple


class Table(NamedTuple):
    """A titled table. columns: name with unit -> format of its numbers ("" for text); rows: a value a column."""

    title: str
    columns: dict[str, str]
    rows: list[tuple[Any, ...]]
    note: str = ""

    def markdown(self) -> str:
        """The table in Markdown, columns aligned; None is shown as a dash."""
        cells = [tuple(self.columns), *self.cells]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        text = [not spec for spec in self.columns.values()]
        rule = [
            ("-" * width if is_text else "-" * (width - 1) + ":") for width, is_text in zip(widths, text, strict=True)
        ]
        lines = [_line(row, widths, text) for row in cells]
        parts = [
            f"## {self.title}" if self.title else "",
            "\n".join([lines[0], _line(rule, widths, text), *lines[1:]]),
            self.note,
        ]
        return "\n\n".join(part for part in parts if part) + "\n"

    def records(self) -> list[dict[str, Any]]:
        """A dictionary a row, numbers as they are."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]

    @property
    def cells(self) -> list[tuple[str, ...]]:
        """The rows as text."""
        formats = self.columns.values()
        return [tuple(map(_text, row, formats)) for row in self.rows]


def _text(value: Any, spec: str) -> str:
    return "-" if value is None else value if isinstance(value, str) else format(value, spec)


def _line(cells: Sequence[str], widths: list[int], text: list[bool]) -> str:
    padded = (
        cell.ljust(width) if is_text else cell.rjust(width)
        for cell, width, is_text in zip(cells, widths, text, strict=True)
    )
    return f"| {' | '.join(padded)} |"
