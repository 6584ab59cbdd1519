"""`fes_mj validate --explain`: what a check, or a limit of a search, guards against."""

from dataclasses import asdict

from fes_mj.cli.options import PrintOptions
from fes_mj.common.checks import Definition, definitions, find
from fes_mj.common.console import number, print_table, say
from fes_mj.optimization.limits import MEANINGS, Meaning

ALL = "all"
_OPTIONS = {"knee_speed": "--knee-speed-limit", "hip_speed": "--hip-speed-limit", "speed_ripple": "--ripple-limit"}


def explain(name: str, options: PrintOptions) -> int:
    """A check or a limit by its name, however it is spaced, or the table of all checks. Raises InputError for none."""
    if name == ALL:
        checks = definitions().values()
        options.show(lambda: {"checks": [asdict(check) for check in checks]}, lambda: _print_all([*checks]))
    elif meaning := MEANINGS.get(key := name.strip().lower().replace(" ", "_").replace("-", "_")):
        meaning = meaning._replace(where=_OPTIONS.get(key, meaning.where))
        options.show(lambda: {"name": name} | meaning._asdict(), lambda: _print_limit(name, meaning))
    else:
        check = find(name)
        options.show(lambda: asdict(check), lambda: _print_check(check))
    return 0


def _print_all(checks: list[Definition]) -> None:
    rows = [(check.name, check.kind, number(check.limit, check.unit)) for check in checks]
    print_table("Checks", ("check", "kind", "limit"), rows)


def _print_limit(name: str, meaning: Meaning) -> None:
    say(f"{name}: {meaning.words}", "bold")
    say(f"  a limit of `fes_mj optimize`; where it is set: {meaning.where}")
    say("  `fes_mj optimize ... --print-problem` writes the problem file that has it")


def _print_check(check: Definition) -> None:
    say(f"{check.name}: {check.quantity}", "bold")
    say(f"  kind: {check.kind}")
    say(f"  limit: {number(check.limit, check.unit)}: {check.reason}")
    say(f"  guards against: {check.guards}")
    say(f"  usually broken by: {check.breaks}")
