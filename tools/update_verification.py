"""Write results/verification.json and results/verification.md: every check, refined run and injected fault."""

import contextlib
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fes_mj.cli.app import run
from fes_mj.common.markdown import Table
from fes_mj.common.writing import write_text
from fes_mj.verification.problems import compare_chains, run_four_bar

FOLDER = Path("results")


def main() -> None:
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        code = run(["validate", "--faults", "--json"])
    if code:
        raise SystemExit(f"validate ended with {code}: {output.getvalue()[-2000:]}")
    content = json.loads(output.getvalue())
    head = (
        "# Verification\n\nWritten by tools/update_verification.py; every number is in verification.json.\n\n"
        f"{len(content['checks'])} checks hold, {len(content['faults'])} injected faults are caught.\n"
    )
    tables = [*runs(content["runs"]), problems(), faults(content["faults"])]
    write_text(FOLDER / "verification.json", output.getvalue())
    write_text(FOLDER / "verification.md", "\n".join([head, *(table.markdown() for table in tables)]))


def runs(rows: list[dict[str, Any]]) -> Iterator[Table]:
    names = [f"{row['design']} {row['group']}" for row in rows]
    yield Table(
        "Mean crank power of one leg",
        {
            "run": "",
            "step, ms": ".3f",
            "static, W": ".3f",
            "dynamic, W": ".3f",
            "numerical uncertainty, W": ".4f",
            "difference, %": "+.4f",
        },
        [
            (
                name,
                1e3 * row["timestep_s"],
                row["static_power_mean_W"],
                row["power_mean_W"],
                row["numerical_uncertainty_W"],
                100 * row["relative_difference"],
            )
            for name, row in zip(names, rows, strict=True)
        ],
    )
    for family in ("massless", "massive"):
        apart = [row["crank_moment_differences_Nm"][family] for row in rows]
        yield Table(
            f"Crank moment by {family} methods: largest difference over a turn, N m",
            {"methods": "", **dict.fromkeys(names, ".1e")},
            [(pair, *(row[pair] for row in apart)) for pair in apart[0]],
            "What the simulation differs by is its time step, most where the torque map jumps, and, in the massless "
            "family, the trace of mass that it keeps.",
        )
    terms = [row["energy_J"] for row in rows]
    cells = [(term, *(row[term] for row in terms)) for term in terms[0]]
    yield Table("Energy over a turn, J", {"term": "", **dict.fromkeys(names, ".5f")}, cells)
    orders = ("gap_order", "power_order", "softness_order", "extrapolated_work_error", "power_uncertainty")
    cells = [(key.replace("_", " "), *(row["refinement"][key] for row in rows)) for key in orders]
    yield Table("Refinement", {"": "", **dict.fromkeys(names, ".3g")}, cells)


def problems() -> Table:
    angle, gap = run_four_bar()
    return Table(
        "Published problems",
        {
            "A02, two windows, 10 s": "",
            "step, ms": "g",
            "energy drift, J": ".2g",
            "loop gap, m": ".2g",
            "distance from the exact path, m": ".2g",
        },
        [
            (
                chain.settings.name,
                1e3 * chain.settings.timestep,
                chain.energy_drift,
                float(chain.gap.max()),
                chain.path_error,
            )
            for chain in compare_chains()
        ],
        f"Newton's four-bar, two turns: {angle:.2g} deg from Freudenstein's equation (its limit: 0.1), "
        f"gap {gap:.2g} m (its limit: 0.001).",
    )


def faults(rows: list[dict[str, Any]]) -> Table:
    return Table(
        "Injected faults",
        {
            "mistake": "",
            "there for it": "",
            "first caught by": "",
            "times its limit": ".2g",
            "checks that noticed": "d",
        },
        [(row["mistake"], ", ".join(row["guards"]), row["check"], row["factor"], len(row["failed"])) for row in rows],
        "Each mistake is put into D1 on its own. A dash: infinitely beyond its limit.",
    )


if __name__ == "__main__":
    main()
