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
from fes_mj.paper.captions import figure_section
from fes_mj.paper.evidence import load_evidence
from fes_mj.paper.known import Known, known
from fes_mj.paper.runs import RUNS, Runs, run_all

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 150  # of the PNG; the SVG is for print

RECORD = "reproduction.json"
Done: TypeAlias = Callable[[], None]


def steps() -> int:
    """How often reproduce calls `done`."""
    from fes_mj.paper.figures import FIGURES

    return RUNS + len(readings.readings()) + len(FIGURES)


def reproduce(folder: Path, done: Done, svg: bool = False) -> list[Path]:
    """Write pages, figures and reproduction.json into an existing folder; `done` is called steps() times.

    svg: figures as SVG beside the PNG. All files appear or none; the same results are the same bytes.
    Returns the files written.
    """
    from fes_mj.paper.figures import FIGURES

    facts, runs = known(load_evidence()), run_all(done)
    pages = _pages(facts, runs, done)
    contents: dict[Path, str | bytes] = {
        folder / name: _page(title, (table.markdown() for table in page)) for name, (title, page) in pages.items()
    }
    contents[folder / "figures.md"] = figures_page()
    for name, draw in FIGURES.items():
        contents |= _figure(folder / "figures" / name, partial(draw, runs, facts), svg)
        done()
    record = {"provenance": provenance(inputs(), ["matplotlib"]), "hyperparameters": facts.hyperparameters.__dict__}
    record["timestep_s"] = {" ".join(map(str, run)): case.simulation.timestep for run, case in runs.dynamic.items()}
    record |= {
        name.removesuffix(".md"): {table.title: table.records() for table in contents}
        for name, (_, contents) in pages.items()
    }
    contents[folder / RECORD] = json_text(record)
    (folder / "figures").mkdir(exist_ok=True)
    write_files(contents)
    return [*contents]


def _pages(facts: Known, runs: Runs, done: Done) -> dict[str, tuple[str, list[Table]]]:
    """Title and tables of every page by file name."""
    spread = recovery.rounding_spread(facts)
    return {
        "identification.md": (
            "Dimensions behind the paper's Table 2",
            [readings.dimensions_table(), readings.ranges_table(), readings.readings_table(done)],
        ),
        "moments.md": (
            "Joint moments recovered from the paper's powers",
            [
                recovery.evidence_table(facts),
                calibration.left_out_table(facts),
                calibration.calibration_table(facts),
                calibration.sensitivity_table(facts, spread),
                recovery.statement_table(facts),
                recovery.knee_table(facts),
                work_shares.share_table(facts),
                recovery.rounding_table(spread),
            ],
        ),
        "powers.md": (
            "Powers, gains and joint ranges beside the paper's",
            [
                tables.power_table(runs),
                tables.gain_table(runs),
                tables.motion_table(runs),
                readings.ranges_table(),
                tables.check_table(runs),
            ],
        ),
        "metrics.md": (
            "The criteria of Section 7 as numbers",
            [
                metrics.size_table(runs),
                metrics.continuity_table(runs, facts),
                metrics.distribution_table(runs, facts),
                metrics.ranking_table(runs, facts),
            ],
        ),
        "people.md": (
            "Who can ride: people instead of the paper's rider",
            [people.percentile_table(), people.population_table(runs)],
        ),
        "riding.md": (
            "How the paper's designs ride",
            [
                table(runs.rides)
                for table in (riding.speed_table, riding.start_table, riding.gear_table, riding.transmission_table)
            ],
        ),
        "gains.md": (
            "How much of the gain is real",
            [
                *(table(runs) for table in (gains.speed_table, gains.hill_table, gains.smoothness_table)),
                stationarity.stationarity_table(),
            ],
        ),
        "error_budget.md": (
            "One error budget",
            [
                error_budget.prior_table(),
                *(
                    table(runs.budgets)
                    for table in (
                        error_budget.contribution_table,
                        error_budget.share_table,
                        error_budget.probability_table,
                        error_budget.better_table,
                    )
                ),
            ],
        ),
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

    return _page("Figures", map(figure_section, FIGURES))


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
