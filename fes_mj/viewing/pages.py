"""HTML pages with everything inside, from the templates of the package that shows them."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from fes_mj.common.errors import require_extra


def require_page_packages() -> None:
    """Raise MissingPartError unless the packages of the extra "report" are there."""
    require_extra("report", "jinja2", "matplotlib")


def page(template: Path, filters: Mapping[str, Callable[..., str]] | None = None, **content: Any) -> str:
    """A page from a Jinja template file, which may extend base.html.j2.

    Text is escaped, a name that the content lacks is an error. filters: name in the template -> function to text.
    Raises MissingPartError as require_page_packages.
    """
    require_page_packages()
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader([template.parent, Path(__file__).parent])
    environment = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters |= filters or {}
    return environment.get_template(template.name).render(**content)
