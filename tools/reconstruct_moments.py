"""Write fes_mj/data/moments: the joint moments recovered from the evidence and from what the text says of the figures.

By group: curves drawn from what is known, as Fourier coefficients (-samples.npz), their mean (.csv), their covariance
(.npy: not compressed, since every start reads it).
"""

from pathlib import Path

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import DATA
from fes_mj.common.writing import replacing, write_text
from fes_mj.moments.files import moments_of
from fes_mj.moments.joint_moments import COLUMNS
from fes_mj.paper.evidence import load_evidence, of_group
from fes_mj.paper.reconstruction import reconstruct
from fes_mj.paper.statements import allowed_curves

FOLDER = DATA / "moments"
CURVES = 1000  # standard deviations are known to 2 %, means to 3 % of one
DIGITS = 4  # of N m, in every file; coefficients of high harmonics become 0 and take no room


def main() -> None:
    evidence = load_evidence()
    chosen, posteriors = reconstruct(evidence)
    print(f"length {chosen.length:g}, amplitude {chosen.amplitude:g} N m")
    for group in posteriors:
        curves, share = allowed_curves(of_group(evidence, group), group, chosen, CURVES)
        print(f"{group}: {100 * share:.2f} % of the curves fulfil what the text says of the figures")
        write(curves.round(DIGITS), FOLDER / f"{group}.csv")


def write(curves: FloatArray, path: Path) -> None:
    """Curves as coefficients, shape (curves, 98), their mean and their covariance, side by side."""
    mean = moments_of(curves.mean(axis=0), path.stem)
    lines = [",".join(COLUMNS)]
    for angle, knee, hip in zip(np.degrees(mean.crank_angle), mean.knee, mean.hip, strict=True):
        lines.append(f"{angle:.0f},{knee:.{DIGITS}f},{hip:.{DIGITS}f}")
    write_text(path, "\n".join(lines) + "\n")
    with replacing(path.with_suffix(".npy")) as temporary:
        np.save(temporary, np.cov(curves.T))
    with replacing(path.with_name(f"{path.stem}-samples.npz")) as temporary:
        np.savez_compressed(temporary, coefficients=curves.astype(np.float32))


if __name__ == "__main__":
    main()
