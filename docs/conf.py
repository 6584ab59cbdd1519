"""The site, made of the repository's own pages: `make docs`. Its source folder is the repository."""

import importlib.metadata
from pathlib import Path

project = "fes_mj"
release = importlib.metadata.version("fes-mj")
copyright = "MIT licence"  # noqa: A001

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
root_doc = "docs/index"
include_patterns = ["*.md", "docs/**", "results/**.md", "mjcf/**.md", "examples/**.md"]
exclude_patterns = ["docs/templates"]
templates_path = [str(Path(__file__).parent / "templates")]  # absolute: autosummary would look beside the sources
html_additional_pages = {"index": "to_readme.html"}

html_theme = "furo"
html_title = "fes_mj"
html_show_copyright = False

myst_heading_anchors = 3  # as on the repository's own pages
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
