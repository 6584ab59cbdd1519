"""What people see on a terminal: aligned tables, and progress on standard error."""

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from rich.console import Console
from rich.text import Text

from fes_mj.common.text import printable
from fes_mj.common.writing import json_text

Item = TypeVar("Item")
GOOD, BAD = "bold green", "bold red"

output = Console(markup=False, emoji=False, highlight=False)
errors = Console(markup=False, emoji=False, highlight=False, stderr=True)


def say(text: str, style: str | None = None) -> None:
    """Print a line as it is, however long."""
    output.print(printable(text), style=style, soft_wrap=True)


def print_json(content: Mapping[str, Any]) -> None:
    """Print an object as JSON, as files have it."""
    sys.stdout.write(json_text(content))


def complain(text: str) -> None:
    """Print a warning on standard error."""
    errors.print(printable(f"warning: {text}"), style="yellow", soft_wrap=True)


def conclude(ok: bool, result: str, more: str) -> None:
    """Print what came out, in colour, and more about it."""
    output.print(Text.assemble((result, GOOD if ok else BAD), printable(more)), soft_wrap=True)


def print_table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str | Text]]) -> None:
    """Print a title and a table, first column left, the others right aligned."""
    from rich.box import SIMPLE_HEAD
    from rich.measure import measure_renderables
    from rich.table import Table

    say(title, "bold")
    table = Table(box=SIMPLE_HEAD)
    for number, column in enumerate(columns):
        table.add_column(column, justify="right" if number else "left")
    for row in rows:
        table.add_row(*(printable(cell) if isinstance(cell, str) else cell for cell in row))
    # a narrow screen may wrap lines, but no digit is left out
    table.width = measure_renderables(output, output.options.update(max_width=1000), [table]).maximum
    output.print(table, crop=False)


@contextmanager
def progress_bar(what: str, total: int, silent: bool = False, done: int = 0) -> Iterator[Callable[[int], None]]:
    """A bar on standard error with rate and time left; call what it gives with the number of steps just made."""
    from rich import progress

    class Rate(progress.ProgressColumn):
        def render(self, task: progress.Task) -> Text:
            return Text(f"{task.speed:,.3g}/s" if task.speed else "")

    what_and_bar = (progress.TextColumn("{task.description}", markup=False), progress.BarColumn())
    columns = (*what_and_bar, progress.MofNCompleteColumn(), Rate(), progress.TimeRemainingColumn())
    hidden = silent or not errors.is_terminal
    with progress.Progress(*columns, console=errors, transient=True, disable=hidden) as bars:
        task = bars.add_task(printable(what), total=total, completed=done)
        yield lambda steps: bars.update(task, advance=steps)


def track(items: Sequence[Item], what: str, silent: bool = False) -> Iterator[Item]:
    """The items one by one, with a progress bar that is gone when they are through."""
    with progress_bar(what, len(items), silent) as advance:
        for item in items:
            yield item
            advance(1)


def number(value: float, unit: str = "") -> str:
    """A value with two digits and its unit."""
    return f"{value:.2g} {unit}".rstrip()


def check_word(ok: bool, otherwise: str = "FAILED") -> Text:
    """Whether a check holds, in colour."""
    return Text("ok", "green") if ok else Text(otherwise, BAD)
