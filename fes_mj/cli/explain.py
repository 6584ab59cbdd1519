"""`fes_mj explain`: what a check guards against and what usually breaks it."""

from __future__ import annotations

from fes_mj.checks import criteria, find
from fes_mj.cli.output import number, output, print_table


def explain(check: str | None = None, /) -> int:
    """What a check guards against and what usually breaks it; without a name, the list of checks.

    Parameters
    ----------
    check
        A check as `simulate` or `validate` names it, for example mean_power.
    """
    if check is None:
        rows = [(name, row.kind, number(row.limit, row.unit)) for name, row in criteria().items()]
        print_table("Checks", ("check", "kind", "limit"), rows)
        return 0
    row = find(check)
    output.print(f"{row.name}: {row.quantity}", style="bold", markup=False, soft_wrap=True)
    for title, text in (
        ("kind", row.kind),
        ("limit", f"{number(row.limit, row.unit)}: {row.reason}"),
        ("guards against", row.guards),
        ("usually broken by", row.breaks),
    ):
        output.print(f"  {title}: {text}", markup=False, soft_wrap=True)
    return 0
