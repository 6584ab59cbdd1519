"""`fes_mj validate --against`: predictions beside measurements, a report: what contradicts is no failure."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fes_mj.cli.options import PrintOptions
from fes_mj.common.console import complain, print_table, say, track
from fes_mj.common.errors import InputError
from fes_mj.common.provenance import provenance

PUBLISHED = "published"
_ENOUGH = 20  # riders, below which their quantiles say little


def against(what: str, options: PrintOptions) -> int:
    """Published measurements, or an experiment of one's own."""
    if what == PUBLISHED:
        _published(options)
    elif what.endswith(".toml"):
        _experiment(Path(what), options)
    else:
        raise InputError(f"--against is {what!r}; it must be {PUBLISHED}, or the .toml file of an experiment")
    return 0


def _published(options: PrintOptions) -> None:
    from fes_mj.validation.published import PUBLISHED_FILE, RULE, counts, rows

    records = [row.record() for row in track(rows(), "predicting", options.silent)]
    options.show(
        lambda: {
            "rule": RULE,
            "verdicts": counts(records),
            "rows": records,
            "provenance": provenance([PUBLISHED_FILE]),
        },
        lambda: _print_rows(records, RULE, counts(records)),
    )


def _print_rows(records: list[dict[str, Any]], rule: str, verdicts: dict[str, int]) -> None:
    columns = ("measured", "predicted by", "predicted, 5 to 95 %", "measured", "verdict")
    for kind, title in (("measurement", "Measurements"), ("model", "Models of others: consistency, not validation")):
        cells = []
        for record in (record for record in records if record["kind"] == kind):
            by, measured = f"{record['drive']}; {record['timing']}", interval_words(record["measured"])
            if record["unit"] != "1":
                measured += f" {record['unit']}"
            cells.append((record["name"], by, _quantiles(record["predicted"]), measured, record["verdict"]))
        print_table(title, columns, cells)
    for record in records:
        if record["unless"]:
            say(f"{record['name']}: contradicts, unless {record['unless']}.")
    say(rule)
    say(", ".join(f"{count} {verdict}" for verdict, count in verdicts.items()), "bold")


def interval_words(ends: list[float | None]) -> str:
    """A measured interval or direction, in words."""
    low, high = ends
    if high is None:
        return f"above {low:g}"
    return f"below {high:g}" if low is None else f"{low:g} to {high:g}"


def _experiment(path: Path, options: PrintOptions) -> None:
    from fes_mj.validation.experiment import Experiment, judged

    experiment = Experiment.read(path)
    result = judged(experiment)
    if result["riders_effective"] < _ENOUGH:
        complain(f"{path}: the weighed riders are worth {result['riders_effective']:.0f}: intervals are rough")
    options.show(lambda: {**result, "provenance": provenance(experiment.files)}, lambda: _print_experiment(result))


def _print_experiment(result: Mapping[str, Any]) -> None:
    print_table("Best power", ("cadence, rpm", "W"), [(rpm, f"{p:.1f}") for rpm, p in result["best_power_W"].items()])
    say(f"a rider of the model misses the measured numbers by {result['misfit_rms']:.2f} of their errors (rms)")
    probabilities = []
    for name in result["after"]:
        both = [result[when][name] for when in ("before", "after")]
        chances = (f"{100 * row[least]:.0f}" for least in ("P(gain > 1.0)", "P(gain > 1.25)") for row in both)
        probabilities.append((name.upper(), *(_quantiles(row["gain"]) for row in both), *chances))
    columns = ("design", "gain before", "after", "P(> 1) before, %", "after", "P(> 1.25) before, %", "after")
    print_table("Power per the traditional tricycle's, best stimulated", columns, probabilities)
    quantities = [
        (name, row["unit"], _quantiles(row["before"]), _quantiles(row["after"]))
        for name, row in result["quantities"].items()
    ]
    print_table("What is known of the rider", ("quantity", "unit", "before", "after"), quantities)


def _quantiles(values: list[float]) -> str:
    """Middle, and the ends of 90 %."""
    low, middle, high = values
    return f"{middle:.3g} ({low:.3g} to {high:.3g})"
