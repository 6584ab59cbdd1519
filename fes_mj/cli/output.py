"""What people and programs see: aligned tables on a terminal, one JSON object on standard output."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from fes_mj.files import json_text as json_text

Item = TypeVar("Item")

output = Console(highlight=False)
errors = Console(stderr=True, highlight=False)


def print_json(content: dict[str, Any]) -> None:
    """Print one JSON object; numbers that JSON lacks (NaN, infinity) become null."""
    sys.stdout.write(json_text(content))


def print_table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print a title and a table, first column left, the others right aligned."""
    output.print(title, style="bold", markup=False, soft_wrap=True)
    table = Table(box=SIMPLE_HEAD)
    for number, column in enumerate(columns):
        table.add_column(column, justify="right" if number else "left")
    for row in rows:
        table.add_row(*row)
    output.print(table)


@contextmanager
def progress_bar(what: str, total: int, silent: bool, done: int = 0) -> Iterator[Callable[[int], None]]:
    """A bar on standard error with rate and time left; call what it gives with the number of steps just made."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, Task, TimeRemainingColumn
    from rich.text import Text

    class Rate(ProgressColumn):
        def render(self, task: Task) -> Text:
            return Text(f"{task.speed:,.3g}/s" if task.speed else "")

    columns = ("{task.description}", BarColumn(), MofNCompleteColumn(), Rate(), TimeRemainingColumn())
    with Progress(*columns, console=errors, transient=True, disable=silent) as bars:
        task = bars.add_task(what, total=total, completed=done)
        yield lambda steps: bars.update(task, advance=steps)


def number(value: float, unit: str = "") -> str:
    """A value with two digits and its unit."""
    return f"{value:.2g} {unit}".rstrip()


def verdict(ok: bool) -> str:
    """The verdict on a check, in colour."""
    return "[green]ok[/]" if ok else "[bold red]FAILED[/]"


def track(items: Sequence[Item], title: str, quiet: bool = False) -> Iterator[Item]:
    """The items one by one, with a progress bar on standard error that is gone when they are through."""
    with Progress(console=errors, transient=True, disable=quiet) as progress:
        yield from progress.track(items, description=title)
