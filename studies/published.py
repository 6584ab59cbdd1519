"""Write results/published.*: what is predicted beside what somebody measured. python -m studies.published"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fes_mj.common.markdown import Table
from fes_mj.common.provenance import provenance
from fes_mj.common.style import SERIES
from fes_mj.common.writing import json_text, write_text
from fes_mj.muscles.riders import load_riders
from fes_mj.validation.machines import stepping_per_cycling
from fes_mj.validation.published import PUBLISHED_FILE, RULE, VERDICTS, counts, rows
from fes_mj.viewing.charts import write_figure

PATH = Path(__file__).parents[1] / "results" / "published.md"
TITLES = {"measurement": "Measurements", "model": "Models of others"}
COLUMNS = {
    **dict.fromkeys(("measurement", "predicted by", "unit"), ""),
    **dict.fromkeys(("predicted 5 %", "predicted 50 %", "predicted 95 %", "measured from", "to"), ".3g"),
    "verdict": "",
}
STEPPING = """Median of P1P2 at 20 rpm, per cycling on the standard tricycle, whose knee is at 58 deg where it is
straightest. A path as high as long is a crank's circle: what gives more power is the straighter knee, and a seat
farther from the crank gives it as well."""
INTRODUCTION = """# Predictions beside measurements

Written by `python -m studies.published`; on the terminal `fes_mj validate --against published`. Nothing is fitted to
the number that it is compared with. Every set-up, and what had to be assumed because a source does not say it or could
only be read in its abstract, stands below and in [published.toml](../fes_mj/data/published.toml).

Not compared, because not blind: the rise of force in 80 ms (Bickel 2004), which is among the priors; the knee's shares
of the work and 15 W a leg (Szecsi 2014), which are among the evidence of the ensembles. Not compared, because nothing
in the model predicts it: other electrodes (+18 to +132 % of power, doi:10.1186/s12984-018-0471-y), shear in the femur
of a seated rider (a model, PMC3324830).
"""


def tables(records: list[dict[str, Any]]) -> list[Table]:
    """One of measurements, one of models."""
    by_kind = []
    for kind, title in TITLES.items():
        cells = [
            (
                record["name"],
                f"{record['drive']}; {record['timing']}",
                record["unit"].replace("1", "ratio"),
                *record["predicted"],
                *record["measured"],
                record["verdict"],
            )
            for record in records
            if record["kind"] == kind
        ]
        by_kind.append(Table(title, COLUMNS, cells))
    summary = {"verdict": "", "measurements": "d"}
    parts = {"straightest knee, deg": "d", "half stride, m": ".2f", "height per length": ".2f", "power ratio": ".2f"}
    why = Table("Why elliptical stepping gives more", parts, [*stepping_rows()], STEPPING)
    return [Table("Verdicts", summary, [*counts(records).items()]), *by_kind, why]


def stepping_rows() -> Iterator[tuple[Any, ...]]:
    """Of which part of an elliptical stepper more power comes: P1P2 at 20 rpm, per the standard tricycle."""
    riders = load_riders("p1p2")
    for knee in (30, 58):
        for crank, flatness in ((0.15, 0.4), (0.15, 0.99), (0.1, 0.4)):
            setup = {"cadence_rpm": [20], "crank_m": [crank], "flatness": [flatness], "knee_deg": [knee]}
            yield knee, crank, flatness, float(np.median(stepping_per_cycling(riders, setup)))


def details(record: dict[str, Any]) -> str:
    """What a reader asks of a row."""
    lines = [
        f"### {record['name']}",
        f"{record['question']} Asked of {' and '.join(record['riders']).upper()}: {record['quantity']}.",
        f"- measured: {record['said']} ({record['source']})",
        f"- assumed: {record['assumed']}",
        f"- verdict: **{record['verdict']}**",
    ]
    lines += [f"- what would have to be true: {record['unless']}"] if record["unless"] else []
    return "\n\n".join(lines[:2]) + "\n\n" + "\n".join(lines[2:]) + "\n"


def figure(records: list[dict[str, Any]]) -> Figure:
    """Predictions in units of the measurement: its interval from -1 to 1, of a direction its side of 0."""
    shown = [record for record in records if record["kind"] == "measurement"]
    picture = Figure(figsize=(7.2, 0.3 * len(shown) + 1), layout="constrained")
    axes: Any = picture.subplots()
    for place, record in enumerate(reversed(shown)):
        low, high = record["measured"]
        edge = low if high is None else high if low is None else (low + high) / 2
        scale = abs(edge or 1) if None in (low, high) else (high - low) / 2
        ends = [max(-6.0, min(6.0, (value - edge) / scale)) for value in record["predicted"]]
        axes.barh(place, [2, 6][None in (low, high)], left=-1 if None not in (low, high) else 0, color="#d9dce1")
        colour = SERIES[(2, 1, 0)[VERDICTS.index(record["verdict"])]]
        axes.plot([ends[0], ends[2]], [place, place], color=colour, lw=3)
        axes.plot(ends[1], place, "o", color=colour)
    axes.set(
        xlim=(-6, 6),
        ylim=(-0.7, len(shown) - 0.3),
        yticks=range(len(shown)),
        xlabel="prediction in half widths of the measurement (grey),\nbeside a direction in its own unit",
    )
    axes.set_yticklabels([record["name"] for record in reversed(shown)], fontsize=8)
    for name, colour in zip(VERDICTS, (SERIES[2], SERIES[1], SERIES[0]), strict=True):
        axes.plot([], [], color=colour, lw=3, label=name)
    picture.legend(loc="outside lower center", ncols=3)
    return picture


def main() -> None:
    records = [row.record() for row in rows()]
    page_tables = tables(records)
    picture = PATH.with_suffix(".png")
    pages = [INTRODUCTION + "\n" + RULE, *(table.markdown() for table in page_tables)]
    pages += ["![Predictions in half widths of the measurements](published.png)\n", "## Row by row\n"]
    write_text(PATH, "\n\n".join(page.rstrip() for page in [*pages, *map(details, records)]) + "\n")
    content = {table.title: table.records() for table in page_tables} | {"count": sum(counts(records).values())}
    write_text(
        PATH.with_suffix(".json"), json_text({"provenance": provenance([PUBLISHED_FILE]), "rows": records, **content})
    )
    write_figure(picture, figure, records)


if __name__ == "__main__":
    main()
