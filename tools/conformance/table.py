"""The readers' answers in Markdown."""

from __future__ import annotations

from tools.conformance.judging import ENERGY_LIMIT, GAP_LIMIT, Row
from tools.conformance.motions import CONTROLS, FIRST, HORIZON, MOTIONS
from tools.conformance.readers import READERS

HEADING = f"""# Readers of the exported models

Written by `python -m tools.conformance` (`make readers`). Each reader loads the model that `fes_mj export` writes by
default and, for readers without `discrete` (`compatible`), with loops at sites or on bodies: one leg and two that
nothing drives (`passive`), motors (`free`, with {CONTROLS["hip"]:g} N m at the hip and {CONTROLS["knee"]:g} at the
knee) and the road (`passive ride fixed-gear`). Compared with MuJoCo: joint accelerations at the start of each, the
pedal of one leg after {FIRST:g} s, and until {HORIZON:g} s energy (limit: {100 * ENERGY_LIMIT:g} % of the start energy)
and loops (limit: {1e6 * GAP_LIMIT:g} um). Every reader must be left with one degree of freedom.

"""


def table(rows: list[Row]) -> str:
    """The rows in Markdown: what is kept and how it moves, and what the limits mean."""
    lines = [
        "| reader | design | default model | loops kept at sites / on bodies | pedal error, mm (limit) "
        "| acceleration error (limit), rad/s²: " + " | ".join(MOTIONS) + " | verdict |",
        "|---|---|---|---|---:|" + "---:|" * len(MOTIONS) + "---|",
    ]
    for row in rows:
        at_sites, on_bodies = f"{row.loops_at_sites} of {row.loops}", f"{row.loops_on_bodies} of {row.loops}"
        errors = (
            f"{motion.acceleration:.1e} ({motion.acceleration_limit:.1e})" if motion else "-"
            for motion in map(row.motions.get, MOTIONS)
        )
        lines.append(
            f"| {READERS[row.reader].title} {row.version} | {row.design.upper()} | {row.default_model} "
            f"| {at_sites} / {on_bodies} | {1e3 * row.pedal_error:.1e} ({1e3 * row.pedal_limit:.1e}) "
            f"| {' | '.join(errors)} | {'ok' if row.ok else '**FAILED**'} |"
        )
    moving = [motion for motion in MOTIONS if motion != "motors"]
    lines += [
        "",
        "| reader | design | energy error, % / loop gap, um: " + " | ".join(moving) + " |",
        "|---|---|" + "---:|" * len(moving),
    ]
    for row in rows:
        cells = (
            f"{100 * motion.energy:.2g} / {1e6 * motion.gap:.2g}" if motion and motion.moved else "-"
            for motion in map(row.motions.get, moving)
        )
        lines.append(f"| {READERS[row.reader].title} | {row.design.upper()} | {' | '.join(cells)} |")
    lines += ["", "| reader | anchors | what its limits allow for | drops | does without |", "|---|---|---|---|---|"]
    for name in dict.fromkeys(row.reader for row in rows):
        dropped = dict.fromkeys(part for row in rows if row.reader == name for part in row.drops)
        reader = READERS[name]
        without = [
            *(f"{motion}: {why}" for motion, why in reader.without.items()),
            *(f"{motion}: only begun" for motion in reader.still),
            *([f"the horizon: {reader.most} steps a motion"] if reader.most else []),
            *([f"the model's time step: 1/{reader.parts} of it"] if reader.parts > 1 else []),
        ]
        lines.append(
            f"| {reader.title} | {reader.anchors} | {reader.reason} | {', '.join(dropped) or 'nothing'} "
            f"| {'; '.join(without) or '-'} |"
        )
    return "\n".join(lines) + "\n"
