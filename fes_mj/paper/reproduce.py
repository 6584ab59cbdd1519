"""Write everything that is said about the paper: tables, figures and numbers with their provenance."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from fes_mj.common.errors import InputError
from fes_mj.common.markdown import Table
from fes_mj.common.provenance import provenance
from fes_mj.common.reading import DATA, read_json
from fes_mj.common.style import STYLE
from fes_mj.common.writing import json_text, write_files
from fes_mj.paper import (
    calibration,
    error_budget,
    gains,
    metrics,
    people,
    readings,
    recovery,
    riding,
    stationarity,
    tables,
    work_shares,
)
from fes_mj.paper.captions import figure_section, page_title
from fes_mj.paper.runs import RUNS, Runs, run_all

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 150  # of the PNG; the SVG is for print

RECORD = "reproduction.json"
Done: TypeAlias = Callable[[], None]


def steps() -> int:
    """How often reproduce calls `done`."""
    from fes_mj.paper.figures import FIGURES

    return RUNS + len(FIGURES)


def reproduce(folder: Path, done: Done, svg: bool = False) -> list[Path]:
    """Write pages, figures and reproduction.json into an existing folder; `done` is called steps() times.

    svg: figures as SVG beside the PNG. All files appear or none; the same results are the same bytes.
    Returns the files written.
    """
    from fes_mj.paper.figures import FIGURES

    runs = run_all(done)
    pages = _pages(runs)
    contents: dict[Path, str | bytes] = {
        folder / f"{name}.md": _page(page_title(name), (table.markdown() for table in tables))
        for name, tables in pages.items()
    }
    contents[folder / "figures.md"] = figures_page()
    for name, draw in FIGURES.items():
        contents |= _figure(folder / "figures" / name, partial(draw, runs), svg)
        done()
    record = {
        "provenance": provenance(inputs(), ["matplotlib"]),
        "hyperparameters": vars(runs.known.hyperparameters),
        "timestep_s": {" ".join(map(str, run)): case.simulation.timestep for run, case in runs.dynamic.items()},
        **{name: {table.title: table.records() for table in tables} for name, tables in pages.items()},
    }
    contents[folder / RECORD] = json_text(record)
    (folder / "figures").mkdir(exist_ok=True)
    write_files(contents)
    return [*contents]


def _pages(runs: Runs) -> dict[str, list[Table]]:
    """Tables of every page by its name."""
    facts, rides, budgets = runs.known, runs.rides, runs.budgets
    return {
        "identification": [
            readings.dimensions_table(),
            readings.ranges_table(),
            readings.readings_table(runs.readings),
        ],
        "moments": [
            recovery.evidence_table(facts),
            calibration.left_out_table(facts),
            calibration.calibration_table(facts),
            calibration.sensitivity_table(facts),
            recovery.statement_table(facts),
            recovery.knee_table(facts),
            work_shares.share_table(facts),
            recovery.rounding_table(facts),
        ],
        "powers": [
            tables.power_table(runs),
            tables.gain_table(runs),
            tables.motion_table(runs),
            readings.ranges_table(),
            tables.check_table(runs),
        ],
        "metrics": [
            metrics.size_table(runs),
            metrics.continuity_table(runs),
            metrics.distribution_table(runs),
            metrics.ranking_table(runs),
        ],
        "people": [people.percentile_table(), people.population_table(runs)],
        "riding": [
            riding.speed_table(rides),
            riding.start_table(rides),
            riding.gear_table(rides),
            riding.transmission_table(rides),
        ],
        "gains": [
            gains.speed_table(runs),
            gains.hill_table(runs),
            gains.smoothness_table(runs),
            stationarity.stationarity_table(),
        ],
        "error_budget": [
            error_budget.prior_table(),
            error_budget.contribution_table(budgets),
            error_budget.share_table(budgets),
            error_budget.probability_table(budgets),
            error_budget.better_table(budgets),
        ],
    }


def require_ours(folder: Path) -> None:
    """Raise InputError unless a folder holds an earlier reproduction, which is replaced, or no file at all."""
    record = folder / RECORD
    earlier = read_json(record, "record of the results").get("provenance") if record.exists() else None
    if not (isinstance(earlier, dict) and "fes_mj" in earlier) and any(path.is_file() for path in folder.rglob("*")):
        raise InputError(f"{folder}: this folder is not empty and holds no {RECORD} of fes_mj; name a new one")


def inputs() -> list[Path]:
    """The data files that the results depend on."""
    shared = [
        DATA / f"{name}.toml" for name in ("paper", "evidence", "error_budget", "riders", "text", "torque_velocity")
    ]
    return [*shared, *sorted((DATA / "designs").glob("*/*")), *sorted((DATA / "moments").iterdir())]


def figures_page() -> str:
    """The page with every figure and its caption."""
    from fes_mj.paper.figures import FIGURES

    return _page(page_title("figures"), map(figure_section, FIGURES))


def _page(title: str, sections: Iterable[str]) -> str:
    origin = "Written by `fes_mj reproduce`; versions and inputs: reproduction.json. Errors are one standard deviation."
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
