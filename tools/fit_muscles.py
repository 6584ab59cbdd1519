"""Write fes_mj/data/muscles/p1p2.npz and p1p3.npz: riders whose muscles may have given the evidence of the moments.

python -m tools.fit_muscles
"""

import numpy as np

from fes_mj.common.reading import read_toml
from fes_mj.linkage import kinematics
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import power_weights
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.identification import WHOLE, Measured, identify_riders
from fes_mj.muscles.posterior import MEMBERS
from fes_mj.muscles.riders import SHIPPED
from fes_mj.muscles.timing import TURN_ANGLES
from fes_mj.paper.evidence import load_evidence, of_group
from fes_mj.paper.reconstruction import EvidenceSystem
from fes_mj.paper.statements import TEXT_FILE

CANDIDATES = 40_000
SEED = 26
# Who does the work that the text gives to extensors or flexors of the knee.
WORKERS = {"knee extensors": "quadriceps", "knee flexors": "hamstrings"}
WORK_W = 15.0  # per leg, of which the shares are
SHARE_SD = 0.25  # of the work: what 100 % is, is not said


def measured(group: str) -> Measured:
    """The numbers from which a rider group's moments were recovered, and its work shares, as measured numbers."""
    system = EvidenceSystem.of(of_group(load_evidence(), group))
    shares = [row for row in read_toml(TEXT_FILE, "statements").content["share"] if row["group"] == group]
    work_shares = [
        (MUSCLE_GROUPS.index(WORKERS[row["muscles"]]), row["value"] / 100)
        for row in shares
        if row["muscles"] in WORKERS
    ]
    power = power_weights(kinematics.solve(PAPER_TRICYCLE.design, TURN_ANGLES), PAPER_TRICYCLE.cadence, PAPER_TRICYCLE)
    return Measured(
        np.concatenate([system.weights, np.tile(power, (len(work_shares), 1))]),
        np.array([WHOLE] * len(system.values) + [number for number, _ in work_shares]),
        np.concatenate([system.values, [WORK_W * share for _, share in work_shares]]),
        np.diag(np.concatenate([system.errors**2, np.full(len(work_shares), (WORK_W * SHARE_SD) ** 2)])),
    )


def main() -> None:
    for group in RIDER_GROUPS:
        posterior = identify_riders(measured(group), np.random.default_rng(SEED), CANDIDATES, group)
        print(f"{group}: {CANDIDATES} candidates are worth {posterior.effective:.0f} independent riders")
        posterior.members(MEMBERS).save(SHIPPED / f"{group}.npz")


if __name__ == "__main__":
    main()
