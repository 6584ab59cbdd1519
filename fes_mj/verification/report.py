"""The report: one HTML file with everything inside, which needs no network."""

from __future__ import annotations

import base64
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fes_mj.checks import Check, criteria
from fes_mj.errors import MissingPartError
from fes_mj.provenance import provenance
from fes_mj.verification.details import Details
from fes_mj.verification.faults import Verdict
from fes_mj.verification.references import differences

_TEMPLATE = Path(__file__).parent / "report.html.j2"


def require_packages() -> None:
    """Raise MissingPartError unless the packages of the extra "report" are there."""
    try:
        import jinja2  # noqa: F401
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise MissingPartError(
            f"no report: the package {error.name} is missing; install `pip install 'fes-mj[report]'`"
        ) from None


def report_html(
    checks: Sequence[Check], verdicts: Sequence[Verdict], found: Sequence[Details], video: Path | None = None
) -> str:
    """Verdict and table of runs, checks, figures, faults, details, provenance; `video` (.mp4) is embedded.

    Raises MissingPartError without the packages of the extra "report".
    """
    require_packages()
    from jinja2 import Environment, StrictUndefined

    from fes_mj.verification import plots
    from fes_mj.verification.problems import compare_chains

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= {"short": short, "fixed": fixed}
    chains = compare_chains()
    worst: dict[str, Check] = {}
    for each in checks:
        if each.name not in worst or each.factor > worst[each.name].factor:
            worst[each.name] = each
    return environment.from_string(_TEMPLATE.read_text(encoding="utf-8")).render(
        ok=all(each.ok for each in checks) and all(each.caught for each in verdicts),
        checks=checks,
        failed=[each for each in checks if not each.ok],
        worst=[(criteria()[name], each) for name, each in worst.items()],
        verdicts=verdicts,
        missed=[each for each in verdicts if not each.caught],
        found=found,
        differences=differences,
        power_curves=[plots.power_curve(each) for each in found],
        refinement_curves=[
            plots.refinement_curve(each.case.name, each.refinement) for each in found if each.refinement
        ],
        chains=chains,
        chain_curve=plots.chain_curve(chains),
        video=base64.b64encode(video.read_bytes()).decode() if video else None,
        provenance=provenance(),
    )


def short(value: Any, unit: str = "") -> str:
    """Two digits and the unit; infinity as such."""
    return "∞" if value == math.inf else f"{value:.2g} {unit}".strip()


def fixed(value: float, digits: int) -> str:
    """A number with so many decimals, if there is one."""
    return "not refined" if math.isnan(value) else f"{value:.{digits}f}"
