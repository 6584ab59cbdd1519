"""Tables of measured numbers as programs leave them: CSV with any separator, and OpenSim's .sto and .mot."""

import csv
import re
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import NoReturn

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import LARGEST_INPUT, read_bytes
from fes_mj.moments.c3d_file import c3d_columns

OPENSIM = (".sto", ".mot")
_END_OF_HEADER = "endheader"
_SEPARATORS = (";", "\t", ",", " ")  # of equals the first; a blank stands for any white space
csv.field_size_limit(LARGEST_INPUT)  # a comment may be long
_LOOKED_AT = 5  # last lines, by which the separator is told
_SHOWN = 40  # letters of a bad cell
_LEAST_ROWS = 10  # all with the same decimals, before a last one with fewer was cut off
_KINDS = "fes_mj reads text tables, CSV (commas, semicolons, tabs or blanks) and OpenSim's .sto and .mot, and .c3d"
# What other files must become first.
_ADVICE = {
    ".mat": "in MATLAB: writetable(struct2table(S), 'trial.csv')",
    ".xlsx": "save the sheet as CSV",
    ".xls": "save the sheet as CSV",
    ".ods": "save the sheet as CSV",
    ".trc": "markers tell no moments: run OpenSim's inverse kinematics and inverse dynamics, which write .mot and .sto",
}
# Names of a column of times, and units that may follow.
_TIME = re.compile(
    r"((?-i:t)|time|timestamp|seconds?|secs?)[ _]*[(\[]?(s|secs?|seconds?|ms|msecs?|milliseconds?)?[)\]]?", re.I
)


@dataclass(frozen=True)
class TextTable:
    """Cells as text, read column by column.

    preamble: the text above the header, which is line `start`. lines: number of each row's line. rows: their cells.
    decimal: what stands before the decimals.
    """

    path: Path
    preamble: str
    start: int
    header: list[str]
    lines: list[int]
    rows: list[list[str]]
    decimal: str = "."

    def cells(self, name: str) -> list[str]:
        """A column as text. Raises InputError naming file, line and column, and what is nearly it."""
        if name not in self.header:
            from difflib import get_close_matches

            names = ", ".join(self.header) or "nothing"
            near = get_close_matches(name.lower(), [column.lower() for column in self.header], 1)
            meant = [column for column in self.header if [column.lower()] == near]
            raise InputError(
                f"{self.path}: line {self.start}: there is no column {name!r}; the header names {names}"
                + "".join(f"; is it {column!r}?" for column in meant)
            )
        if self.header.count(name) > 1:
            raise InputError(f"{self.path}: line {self.start}: the header names the column {name!r} twice")
        place = self.header.index(name)
        return [row[place] for row in self.rows]

    def column(self, name: str) -> FloatArray:
        """The finite numbers of a column, shape (rows,). Raises InputError naming file, line, column and value."""
        cells = zip(self.lines, self.cells(name), strict=True)
        return np.array([self._number(line, name, cell) for line, cell in cells], float)

    def _number(self, line: int, column: str, cell: str) -> float:
        value = _value(cell, self.decimal)
        if not np.isfinite(value):
            shown = cell if len(cell) <= _SHOWN else f"{cell[:_SHOWN]}..."
            advice = "; take rows without a measurement out, the curve bridges them" * (cell.lower() in ("", "nan"))
            raise InputError(f"{self.path}: line {line}: {column} is {shown!r}; it must be a finite number{advice}")
        return value

    def taken(self, rows: Collection[int]) -> "TextTable":
        """The table of these rows."""
        return replace(self, lines=[self.lines[row] for row in rows], rows=[self.rows[row] for row in rows])

    @cached_property
    def angle_unit(self) -> str | None:
        """Unit of angles, rad or deg, by the header of an OpenSim file; None if it does not say."""
        declared = re.search(r"^\s*inDegrees\s*=\s*(yes|no)\s*$", self.preamble, re.IGNORECASE | re.MULTILINE)
        return {"yes": "deg", "no": "rad"}[declared.group(1).lower()] if declared else None

    @cached_property
    def time_column(self) -> str:
        """Which column is the time, by its name; "" if none is."""
        named = [column for column in self.header if _TIME.fullmatch(column)]
        return "time" if "time" in named else next(iter(named), "")

    @property
    def time_unit(self) -> str:
        """The unit that the name of that column says, s or ms."""
        name = _TIME.fullmatch(self.time_column)
        return "ms" if name and (name[2] or "").lower().startswith("m") else "s"


def load_table(path: Path, what: str, expected: Collection[str] = ()) -> TextTable:
    """A table of a text file; blank lines, and lines above and below its header that are none of it, are passed over.

    expected: columns; of several header lines the one counts that names most of them. Raises InputError naming file and
    line, for what is no text table with the way to one, and for a file that is not as long as it says.
    """
    if path.suffix.lower() == ".c3d":
        columns = c3d_columns(path)
        frames = [[*frame] for frame in zip(*columns.values(), strict=True)]
        return TextTable(path, "", 1, [*columns], [*range(1, len(frames) + 1)], frames)
    text = _text(path, what)
    lines = text.splitlines()
    end = next((number for number, line in enumerate(lines, 1) if line.strip().lower() == _END_OF_HEADER), 0)
    if path.suffix.lower() in OPENSIM and not end:
        raise InputError(f"{path}: the {what} has no line {_END_OF_HEADER!r}, below which the columns begin")
    separator = " " if end else _separator(lines)
    cells = [(number, _cells(line, separator)) for number, line in enumerate(lines[end:], end + 1)]
    cells = [(number, row) for number, row in cells if any(row)]
    decimal = "." if separator == "," else ".,"
    head, rows = _split(cells, decimal, expected)
    number, header = cells[head] if cells else (end + 1, [])
    for line, row in rows:
        if len(row) != len(header):
            raise InputError(f"{path}: line {line} has {len(row)} values; the header names {len(header)} columns")
    preamble, numbers = "\n".join(lines[: number - 1]), [line for line, _ in rows]
    table = TextTable(path, preamble, number, header, numbers, [row for _, row in rows], decimal)
    _require_whole(table, what, text.endswith("\n"))
    return table


def _text(path: Path, what: str) -> str:
    """The text of a file: UTF-8, UTF-16 as spreadsheets write it, otherwise Western European."""
    data, suffix = read_bytes(path, what), path.suffix.lower()
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    if suffix in _ADVICE or (b"\0" in data and not wide):
        _refuse_kind(path, suffix)
    try:
        return data.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        if wide:
            _refuse_kind(path, suffix)
        return data.decode("cp1252", errors="replace")


def _refuse_kind(path: Path, suffix: str) -> NoReturn:
    advice = _ADVICE.get(suffix, "export it as one of these")
    raise InputError(f"{path}: this is no text table; {_KINDS}; {advice}")


def _cells(line: str, separator: str) -> list[str]:
    """The cells of a line; numpy marks a header by #."""
    line = line.removeprefix("#")
    row = line.split() if separator == " " else next(csv.reader([line], delimiter=separator), [])
    return [cell.strip() for cell in row]


def _value(cell: str, decimal: str) -> float:
    """The number of a cell, nan if it is none. decimal: the letters that may stand before decimals."""
    try:
        return float(cell.replace(",", ".") if "," in decimal else cell)
    except ValueError:
        return np.nan


def _is_word(cell: str, decimal: str) -> bool:
    """Whether a cell that is not empty cannot be meant as a number."""
    return bool(cell) and cell.lower() != "nan" and np.isnan(_value(cell, decimal))


def _separator(lines: list[str]) -> str:
    """What stands between the cells: that which makes numbers of most of the last lines."""
    last = [line for line in lines if line.strip()][-_LOOKED_AT:]

    def numbers(separator: str) -> tuple[int, int]:
        cells = [cell for line in last for cell in _cells(line, separator)]
        words = sum(_is_word(cell, "." if separator == "," else ".,") for cell in cells)
        return (len(cells) - 2 * words if words < len(cells) else 0), len(cells)

    scores = {separator: numbers(separator) for separator in _SEPARATORS}
    if max(scores.values())[0] > 0:
        return max(_SEPARATORS, key=lambda separator: scores[separator][0])
    return max(_SEPARATORS, key=lambda separator: scores[separator][1])


NumberedCells = tuple[int, list[str]]


def _split(cells: list[NumberedCells], decimal: str, expected: Collection[str]) -> tuple[int, list[NumberedCells]]:
    """Where the header is, and the rows below all lines of words (units, components) that follow it."""
    width = Counter(len(row) for _, row in cells).most_common(1)[0][0] if cells else 0

    def heads(place: int) -> bool:
        row = cells[place][1]
        return len(row) == width and all(not cell or _is_word(cell, decimal) for cell in row)

    first = next(filter(heads, range(len(cells))), 0)
    below = next((place for place in range(first + 1, len(cells)) if not heads(place)), len(cells))
    head = max(range(first, max(below, first + 1)), key=lambda p: len({*cells[p][1]} & {*expected}) if cells else 0)
    return head, cells[below:]


def _require_whole(table: TextTable, what: str, ended: bool) -> None:
    """Refuse a file that was cut off: shorter than its header says, or ending within a number."""
    declared = re.search(r"^\s*(?:nRows|datarows)[ \t]*=?[ \t]*(\d+)\s*$", table.preamble, re.IGNORECASE | re.MULTILINE)
    if declared and int(declared.group(1)) != len(table.rows):
        raise InputError(
            f"{table.path}: the header says {declared.group(0).strip()}, {len(table.rows)} rows are there; was the "
            f"{what} copied before it was written to its end? Write it again, or correct the header"
        )
    if ended or len(table.rows) <= _LEAST_ROWS:
        return
    decimals = [len(re.split("[.,]", row[-1])[-1]) for row in table.rows]
    if 1 < decimals[0] == min(decimals[:-1]) == max(decimals[:-1]) > decimals[-1]:
        raise InputError(
            f"{table.path}: line {table.lines[-1]} ends within a number, {table.header[-1]} {table.rows[-1][-1]!r}, "
            "and without a line end: the file was cut off; write it again, or take that line out"
        )
