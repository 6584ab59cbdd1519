"""Write results/verification.json and results/verification.md: every check, refined run and injected fault."""

import contextlib
import io
import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from fes_mj.cli import run
from fes_mj.files import write_text
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
        f"{len(content['checks'])} checks hold, {len(content['faults'])} injected faults are caught."
    )
    parts = [head, *runs(content["runs"]), *problems(), *faults(content["faults"])]
    write_text(FOLDER / "verification.json", output.getvalue())
    write_text(FOLDER / "verification.md", "\n\n".join(parts) + "\n")


def runs(rows: list[dict[str, Any]]) -> Iterator[str]:
    names = [f"{row['design']} {row['group']}" for row in rows]
    yield "## Mean crank power of one leg"
    yield table(
        ("run", "static, W", "dynamic, W", "numerical uncertainty, W", "difference, %"),
        (
            (
                name,
                f"{row['static_power_mean_W']:.3f}",
                f"{row['power_mean_W']:.3f}",
                f"{row['numerical_uncertainty_W']:.4f}",
                f"{100 * row['relative_difference']:+.4f}",
            )
            for name, row in zip(names, rows, strict=True)
        ),
    )
    yield "## Crank moment by methods that share little: largest difference over a turn, N m"
    for family in ("massless", "massive"):
        apart = [row["crank_moment_differences_Nm"][family] for row in rows]
        head = (f"{family} methods", *names)
        yield table(head, ((pair, *(f"{each[pair]:.1e}" for each in apart)) for pair in apart[0]))
    yield (
        "What the simulation differs by is its time step, most where the torque map jumps, and, in the massless "
        "family, the trace of mass that it keeps."
    )
    yield "## Energy over a turn, J"
    terms = [row["energy_J"] for row in rows]
    yield table(("term", *names), ((term, *(f"{each[term]:.5f}" for each in terms)) for term in terms[0]))
    yield "## Refinement"
    orders = ("gap_order", "energy_order", "softness_order", "extrapolated_work_error", "power_uncertainty")
    yield table(("", *names), ((key, *(f"{row['refinement'][key]:.3g}" for row in rows)) for key in orders))


def problems() -> Iterator[str]:
    yield "## Published problems"
    yield table(
        ("A02, two windows, 10 s", "step, ms", "energy drift, J", "loop gap, m", "distance from the exact path, m"),
        (
            (
                chain.settings.name,
                f"{1e3 * chain.settings.timestep:g}",
                f"{chain.energy_drift:.2g}",
                f"{chain.gap.max():.2g}",
                f"{chain.path_error:.2g}",
            )
            for chain in compare_chains()
        ),
    )
    angle, gap = run_four_bar()
    yield (
        f"Newton's four-bar, two turns: {angle:.2g} deg from Freudenstein's equation (its limit: 0.1), "
        f"gap {gap:.2g} m (its limit: 0.001)."
    )


def faults(rows: list[dict[str, Any]]) -> Iterator[str]:
    yield "## Injected faults"
    yield table(
        ("mistake", "there for it", "first caught by", "times its limit", "checks that noticed"),
        (
            (
                row["mistake"],
                row["guard"],
                row["check"],
                "infinite" if row["factor"] is None else f"{row['factor']:.2g}",
                str(len(row["failed"])),
            )
            for row in rows
        ),
    )


def table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    """A Markdown table, first column left, the others right aligned."""
    lines = [head, ("---", *("---:" for _ in head[1:])), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


if __name__ == "__main__":
    main()
