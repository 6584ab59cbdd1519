"""Write fes_mj/data/moments: the joint moments recovered from fes_mj/data/evidence.toml, with their covariance."""

from pathlib import Path

import numpy as np

from fes_mj.files import replacing, write_text
from fes_mj.moments import COLUMNS
from fes_mj.paper.evidence import load_evidence
from fes_mj.paper.printed import DATA
from fes_mj.paper.reconstruction import Posterior, reconstruct

FOLDER = DATA / "moments"


def main() -> None:
    chosen, posteriors = reconstruct(load_evidence())
    print(f"length {chosen.length:.3f}, amplitude {chosen.amplitude:.2f} N m")
    for group, posterior in posteriors.items():
        write(posterior, FOLDER / f"{group}.csv")


def write(posterior: Posterior, path: Path) -> None:
    """The mean curves as CSV, and beside it the covariance of their Fourier coefficients as .npz."""
    moments = posterior.moments(path.stem)
    lines = [",".join(COLUMNS)]
    for angle, knee, hip in zip(np.degrees(moments.crank_angle), moments.knee, moments.hip, strict=True):
        lines.append(f"{angle:.0f},{knee:.4f},{hip:.4f}")
    write_text(path, "\n".join(lines) + "\n")
    with replacing(path.with_suffix(".npz")) as temporary:
        np.savez_compressed(temporary, covariance=posterior.covariance)


if __name__ == "__main__":
    main()
