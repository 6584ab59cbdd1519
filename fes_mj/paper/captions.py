"""Tables and figures with the titles, columns and notes of data/captions.toml."""

from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeAlias

from fes_mj.common.markdown import Table
from fes_mj.common.reading import DATA, Section, read_toml

Arguments = ParamSpec("Arguments")
Rows: TypeAlias = Iterable[tuple[Any, ...]]
Value: TypeAlias = Sequence[str] | str


def table(name: str, **values: Value) -> Callable[[Callable[Arguments, Rows]], Callable[Arguments, Table]]:
    """Decorator of a function that yields rows: it returns them as the table of this name; otherwise as `captioned`."""

    def of(rows: Callable[Arguments, Rows]) -> Callable[Arguments, Table]:
        @wraps(rows)
        def made(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Table:
            return captioned(name, rows(*args, **kwargs), **values)

        return made

    return of


def captioned(name: str, rows: Rows, **values: Value) -> Table:
    """The table of this name. values: texts that its title, note or column names have in braces.

    A column with a list in its braces is repeated for each.
    """
    caption, columns = _captions().section(name).content, {}
    for column in caption["columns"]:
        title, _, form = column.partition(" @")
        key = title.partition("{")[2].partition("}")[0]
        for value in values[key] if key else [""]:
            columns[title.format(**{key: value})] = form
    texts = {key: value for key, value in values.items() if isinstance(value, str)}
    return Table(caption["title"], columns, [*rows], caption.get("note", "").format(**texts))


def figure_section(name: str) -> str:
    """A figure on a page in Markdown: title, picture, caption."""
    caption = _captions().section("figure").section(name).content
    return f"## {caption['title']}\n\n![{caption['title']}](figures/{name}.png)\n\n{caption['note']}\n"


def page_names() -> list[str]:
    """Of the pages of results, the names of their files."""
    return [*_captions().section("page").content]


def page_title(name: str) -> str:
    """Of a page of results, by its file's name."""
    return str(_captions().section("page").content[name])


def _captions() -> Section:
    return read_toml(DATA / "captions.toml", "captions")
