"""Do muscles in MuJoCo do what the periodic answer of statics says? The paper's designs, both groups, every timing.

python -m studies.muscle_verification [--out results/muscle_verification.md]
"""

import argparse
from itertools import product
from pathlib import Path
from typing import Any

from fes_mj.common.checks import Check
from fes_mj.common.console import track
from fes_mj.common.markdown import Table
from fes_mj.common.writing import write_text
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.drive import load_muscles
from fes_mj.muscles.rules import RULES
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.suite import verify

ROOT = Path(__file__).parents[1]
COLUMNS = {
    "design": "",
    "group": "",
    "timing": "",
    "statics, W": ".4f",
    "MuJoCo, W": ".4f",
    "difference, %": "+.4f",
    "power curve, W rms": ".4f",
    "activation, in limits": ".2f",
    "moments of a state, N m": ".1e",
    "checks": "d",
    "failed": "d",
}


def row(name: str, group: str, timing: str) -> tuple[Any, ...]:
    """Of the most probable rider of a group on a design."""
    case = VerificationCase(load_design(name), load_muscles(group, timing))
    checks: dict[str, Check] = {check.name: check for check in verify(case)}

    def value(check: str) -> float | None:
        return checks[check].value if check in checks else None

    return (
        *(name.upper(), group, timing, case.static_power_mean, case.simulation.power_mean),
        *(100 * case.relative_difference, value("inverse_dynamics")),
        *(value("muscle_activation"), value("muscle_moments")),
        *(len(checks), sum(not check.ok for check in checks.values())),
    )


def main() -> None:
    """Run all, write the page; exit code 1 if a check fails."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "muscle_verification.md")
    rows = [row(*named) for named in track([*product(DESIGNS, RIDER_GROUPS, RULES)], "muscles")]
    note = "One leg of the most probable rider, at the design's cadence; by-angle, moments belong to joint angles."
    table = Table("Statics and MuJoCo", COLUMNS, rows, note)
    origin = "Written by `python -m studies.muscle_verification`; see docs/muscles.md."
    write_text(parser.parse_args().out, f"# Muscles in MuJoCo and in statics\n\n{origin}\n\n{table.markdown()}")
    raise SystemExit(any(one[-1] for one in rows))


if __name__ == "__main__":
    main()
