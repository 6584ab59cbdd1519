"""Write fes_mj/data/moments/*.csv: the joint moments recovered from fes_mj/data/evidence.toml.

With --rounding: print how far the printed powers may be off because Table 2 is rounded to 1 cm.
"""

import sys
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fes_mj.design import Design
from fes_mj.design_file import load_design
from fes_mj.files import write_text
from fes_mj.kinematics import FULL_TURN
from fes_mj.paper.evidence import functional, load_evidence, power_weights
from fes_mj.paper.identification import ROUNDING, joint_ranges, pack, unpack
from fes_mj.paper.printed import DATA, table1
from fes_mj.paper.reconstruction import choose_hyperparameters, condition, fourier
from fes_mj.torque import COLUMNS, GROUPS


def main() -> None:
    evidence = load_evidence()
    chosen = choose_hyperparameters(evidence)
    print(f"length {chosen.length:.3f}, amplitude {chosen.amplitude:.2f} N m")
    for group in GROUPS:
        rows = [row for row in evidence if row.group == group]
        posterior = condition(rows, chosen)
        moments = posterior.moments(group)
        lines = [",".join(COLUMNS)]
        for angle, knee, hip in zip(np.degrees(moments.crank_angle), moments.knee, moments.hip, strict=True):
            lines.append(f"{angle:.0f},{knee:.4f},{hip:.4f}")
        write_text(DATA / "moments" / f"{group}.csv", "\n".join(lines) + "\n")
        for row in rows:
            weights, value, error = functional(row, fourier)
            mean, deviation = posterior.predict(weights)
            others = condition([other for other in rows if other is not row], chosen)
            left_out = others.predict(weights)
            print(
                f"{row.name:32s} {value:7.2f} +- {error:4.2f}   fitted {mean:7.2f} +- {deviation:4.2f}   "
                f"left out {left_out[0]:7.2f} +- {left_out[1]:4.2f}"
            )


def rounding_spread(batch: int = 10_000, wanted_samples: int = 200) -> None:
    """Spread of each six-bar's power over linkages inside Table 2's rounding that satisfy Table 1's joint ranges."""
    evidence = load_evidence()
    chosen = choose_hyperparameters(evidence)
    posteriors = {g: condition([row for row in evidence if row.group == g], chosen) for g in GROUPS}
    random = np.random.default_rng(2022)
    for name in ("r1", "r2", "d1", "d2"):
        printed, target = load_design(name, "printed"), table1()[name]
        accepted: list[NDArray[np.float64]] = []
        while len(accepted) < wanted_samples:
            lengths = pack(printed.linkage)[:, None, None] + random.uniform(-ROUNDING, ROUNDING, (9, batch, 1))
            designs = replace(printed, linkage=unpack(printed.linkage, lengths))
            error = joint_ranges(designs, FULL_TURN[::8]) - (*target.knee_range, *target.hip_range)
            accepted += list(lengths[:, np.all(np.abs(error) < 0.5, axis=1), 0].T)
        samples = [replace(printed, linkage=unpack(printed.linkage, lengths)) for lengths in accepted[:wanted_samples]]
        weights = np.array([power_weights(sample, fourier) for sample in samples if joint_closes(sample)])
        for group, posterior in posteriors.items():
            powers, own = weights @ posterior.mean, power_weights(load_design(name), fourier) @ posterior.mean
            deviation = np.sqrt(np.mean((powers - own) ** 2))
            print(f"{name} {group}: rms deviation from the identified design {deviation:.2f} W")


def joint_closes(design: Design) -> bool:
    """Whether the linkage closes at every angle of a full turn, not only at the coarse ones."""
    return bool(np.all(np.isfinite(joint_ranges(design))))


if __name__ == "__main__":
    rounding_spread() if "--rounding" in sys.argv else main()
