"""`fes_mj moments TRIAL --fit-muscles`: riders who may have given the moments of a trial."""

from pathlib import Path
from typing import Any

from fes_mj.cli.options import PrintOptions
from fes_mj.common.console import print_table, progress_bar, say
from fes_mj.common.errors import InputError
from fes_mj.moments.joint_moments import GROUPS, JointMoments
from fes_mj.muscles.identification import STAGES
from fes_mj.muscles.trial import MEMBERS, fit_muscles, quantities

_CANDIDATES, _STEPS = 3000, 100  # together a minute on one core


def require_trial(file: str, out: Path | None) -> None:
    """Raise InputError for moments whose muscles ship already, or with nowhere to write riders."""
    if file in GROUPS:
        raise InputError(f"--fit-muscles: the muscles of {file} are known: --drive muscles --group {file}")
    if out is None:
        raise InputError(
            "--fit-muscles takes a minute and needs a place for what it finds: "
            f"`fes_mj moments {file} --fit-muscles -o RIDER.npz`"
        )


def fitted(moments: JointMoments, out: Path, options: PrintOptions) -> dict[str, Any]:
    """Write the riders to `out`; what came out, as JSON names it."""
    with progress_bar("riders", STAGES * _CANDIDATES + _STEPS * MEMBERS, options.silent) as advance:
        riders, share = fit_muscles(moments, _CANDIDATES, _STEPS, advance=advance)
    riders.save(out)
    return {
        "members": len(riders),
        "explained_share": share,
        "muscles": [row._asdict() | {"identified": row.identified} for row in quantities(riders)],
    }


def print_fitted(content: dict[str, Any], out: Path) -> None:
    """The posterior beside the prior, and what to do with it."""
    rows = []
    for row in content["muscles"]:
        ends = (f"{middle:.3g} ({low:.3g} to {high:.3g})" for low, middle, high in (row["prior"], row["posterior"]))
        narrowed = f"{row['narrowed_to']:.2f}" if row["identified"] else "not identified"
        rows.append((f"{row['name']}, {row['unit']}", *ends, narrowed))
    print_table("The rider's muscles: median (5 to 95 %)", ("", "before", "by the trial", "narrowed to"), rows)
    say(
        f"{content['members']} riders, who explain {100 * content['explained_share']:.0f} % of the variance of these "
        "moments"
    )
    say(f"go on with: fes_mj static DESIGN --drive muscles --muscles {out}")
