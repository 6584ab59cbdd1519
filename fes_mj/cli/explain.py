"""`fes_mj explain`: what a check guards against and what usually breaks it."""

from fes_mj.common.checks import definitions, find
from fes_mj.common.console import number, print_table, say


def explain(check: str | None = None, /) -> int:
    """What a check guards against and what usually breaks it; without a name, the list of checks.

    Parameters
    ----------
    check
        A check as `simulate` or `validate` names it, for example mean_power.
    """
    if check is None:
        rows = [(name, row.kind, number(row.limit, row.unit)) for name, row in definitions().items()]
        print_table("Checks", ("check", "kind", "limit"), rows)
        return 0
    row = find(check)
    say(f"{row.name}: {row.quantity}", "bold")
    for title, text in (
        ("kind", row.kind),
        ("limit", f"{number(row.limit, row.unit)}: {row.reason}"),
        ("guards against", row.guards),
        ("usually broken by", row.breaks),
    ):
        say(f"  {title}: {text}")
    return 0
