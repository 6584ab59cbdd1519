"""The report: one HTML file with everything inside, which needs no network."""

import base64
import math
from collections.abc import Sequence
from pathlib import Path

from fes_mj.common.checks import Check, definitions
from fes_mj.common.provenance import provenance
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.faults import Detection
from fes_mj.verification.problems import compare_chains
from fes_mj.verification.references import differences
from fes_mj.viewing.pages import page


def report_html(
    checks: Sequence[Check],
    detections: Sequence[Detection],
    cases: Sequence[VerificationCase],
    video: Path | None = None,
) -> str:
    """Verdict and table of runs, checks, figures, faults, details, provenance; `video` (.mp4) is embedded.

    Raises MissingPartError without the packages of the extra "report".
    """
    from fes_mj.verification import plots

    chains = compare_chains()
    worst: dict[str, Check] = {}
    for check in checks:
        if check.name not in worst or check.factor > worst[check.name].factor:
            worst[check.name] = check
    return page(
        Path(__file__).with_name("report.html.j2"),
        filters={"short": short, "fixed": fixed, "sentence": sentence},
        ok=all(check.ok for check in checks) and all(detection.caught for detection in detections),
        checks=checks,
        failed=[check for check in checks if not check.ok],
        worst=[(definitions()[name], check) for name, check in worst.items()],
        detections=detections,
        missed=[detection for detection in detections if not detection.caught],
        cases=cases,
        differences=differences,
        power_curves=[plots.power_curve(case) for case in cases],
        refinement_curves=[plots.refinement_curve(case.name, case.refinement) for case in cases if case.refined],
        chains=chains,
        chain_curve=plots.chain_curve(chains),
        video=base64.b64encode(video.read_bytes()).decode() if video else None,
        provenance=provenance(),
    )


def short(value: float, unit: str = "") -> str:
    """Two digits and the unit; infinity as such."""
    return "∞" if value == math.inf else f"{value:.2g} {unit}".strip()


def fixed(value: float, digits: int) -> str:
    """A number with so many decimals, if there is one."""
    return "not refined" if math.isnan(value) else f"{value:.{digits}f}"


def sentence(text: str) -> str:
    """With a capital at its begin; units and names stay as they are."""
    return text[:1].upper() + text[1:]
