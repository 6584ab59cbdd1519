"""Write everything that is said about the paper: tables, figures and numbers with their provenance."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fes_mj.common.console import track
from fes_mj.common.markdown import Table
from fes_mj.common.provenance import provenance
from fes_mj.common.reading import DATA
from fes_mj.common.style import STYLE
from fes_mj.common.writing import json_text, require_results, write_results
from fes_mj.paper import error_budget, gains, identification, metrics, recovery, riding, tables
from fes_mj.paper.captions import figure_section, page_names, page_title
from fes_mj.paper.runs import Runs, run_all
from fes_mj.paper.work_shares import work_share_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 150  # of the PNG; the SVG is for print
RECORD_FILE = "reproduction.json"


def reproduce(folder: Path, svg: bool = False, silent: bool = False) -> list[Path]:
    """Write pages, figures and reproduction.json into a folder, which is made if its parent exists.

    svg: figures as SVG beside the PNG. silent: no progress is shown. All files appear or none; the same results are the
    same bytes. Returns the files written. Raises InputError for a folder that cannot be written to, or in which one of
    these names is somebody else's file.
    """
    from fes_mj.paper.figures import FIGURES

    drawn = [f"figures/{name}.{kind}" for name in FIGURES for kind in ("png", *(["svg"] if svg else []))]
    require_results(folder, [*(f"{name}.md" for name in page_names()), *drawn, RECORD_FILE])
    runs = run_all(silent)
    pages = _pages(runs)
    contents: dict[Path, str | bytes] = {
        folder / f"{name}.md": _page(page_title(name), (table.markdown() for table in tables))
        for name, tables in pages.items()
    }
    contents[folder / "figures.md"] = figures_page()
    for name, draw in track([*FIGURES.items()], "figures", silent):
        contents |= _figure(folder / "figures" / name, partial(draw, runs), svg)
    record = {
        "provenance": provenance(inputs(), ["matplotlib"]),
        "hyperparameters": vars(runs.known.hyperparameters),
        "timestep_s": {" ".join(map(str, run)): case.simulation.timestep for run, case in runs.dynamic.items()},
        **{name: {table.title: table.records() for table in tables} for name, tables in pages.items()},
    }
    contents[folder / RECORD_FILE] = json_text(record)
    write_results(contents)
    return [*contents]


def _pages(runs: Runs) -> dict[str, list[Table]]:
    """Tables of every page by its name."""
    moments = (
        *(recovery.evidence_table, recovery.left_out_table, recovery.calibration_table, recovery.sensitivity_table),
        *(recovery.statement_table, recovery.knee_table, work_share_table, recovery.rounding_table),
    )
    ranges = identification.ranges_table()
    of_powers = (tables.answer_table, tables.power_table, tables.gain_table, tables.motion_table)
    criteria = (metrics.size_table, metrics.continuity_table, metrics.distribution_table, metrics.ranking_table)
    rides = (riding.speed_table, riding.start_table, riding.gear_table, riding.transmission_table)
    of_gains = (gains.knee_speed_table, gains.smoothness_table)
    budget = (
        *(error_budget.contribution_table, error_budget.share_table),
        *(error_budget.probability_table, error_budget.better_table),
    )
    return {
        "identification": [identification.dimensions_table(), ranges, identification.readings_table(runs.readings)],
        "moments": [table(runs.known) for table in moments],
        "powers": [*(table(runs) for table in of_powers), ranges, tables.check_table(runs)],
        "metrics": [table(runs) for table in criteria],
        "people": [tables.percentile_table(), tables.population_table(runs.people)],
        "riding": [table(runs.rides) for table in rides],
        "gains": [*(table(runs) for table in of_gains), gains.stationarity_table()],
        "error_budget": [error_budget.prior_table(), *(table(runs.budgets) for table in budget)],
    }


def inputs() -> list[Path]:
    """The data files that the results depend on."""
    shared = [DATA / f"{name}.toml" for name in ("paper", "evidence", "error_budget", "riders", "text")]
    return [*shared, *sorted((DATA / "designs").glob("*/*")), *sorted((DATA / "moments").iterdir())]


def figures_page() -> str:
    """The page with every figure and its caption."""
    from fes_mj.paper.figures import FIGURES

    return _page(page_title("figures"), map(figure_section, FIGURES))


def _page(title: str, sections: Iterable[str]) -> str:
    origin = (
        "Written by `fes_mj reproduce`; versions and inputs: reproduction.json. A +- is one standard deviation, of the "
        "recovered moments alone where a table does not say of what."
    )
    return "\n".join([f"# {title}\n", f"{origin}\n", *sections])


def _figure(stem: Path, draw: Callable[[], Figure], svg: bool) -> dict[Path, bytes]:
    import matplotlib

    pictures = {}
    with matplotlib.rc_context(STYLE):
        figure = draw()
        for kind, metadata in (("png", {"Software": None}), *([("svg", {"Date": None})] if svg else [])):
            stream = io.BytesIO()
            figure.savefig(stream, format=kind, dpi=DPI, metadata=metadata)
            pictures[stem.with_suffix(f".{kind}")] = stream.getvalue()
    return pictures
