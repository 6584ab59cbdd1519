"""Write fes_mj/data/designs/identified from the printed dimensions and Table 1's joint ranges.

Each six-bar as identified (.toml), and linkages drawn from what identification leaves open (-draws.npz).
"""

from typing import Any

import numpy as np

from fes_mj.budget.unknowns import DIMENSIONS, budget_priors
from fes_mj.common.reading import DATA
from fes_mj.common.writing import replacing, write_text
from fes_mj.linkage.assembly import joint_ranges
from fes_mj.linkage.design_file import SIX_BARS, design_toml, load_design
from fes_mj.linkage.variables import LENGTHS, VARIABLES, lengths, with_lengths
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.paper.identification import LENGTH_ROUNDING, identify, inside_rounding
from fes_mj.paper.printed import table1

FOLDER = DATA / "designs" / "identified"
DRAWS = 1000
DIGITS = 6  # 1 um
_SEED = 2022


def half_widths(name: str) -> dict[str, float]:
    """By component how far a linkage may be from the print, in the unit of files."""
    angles = {key: budget_priors()[DIMENSIONS][f"{key}_deg"] for key in ("seat_angle", "gamma")}
    kind = load_design(name).linkage.kind
    return dict.fromkeys(LENGTHS, LENGTH_ROUNDING) | {
        symbol: width for symbol, width in angles.items() if kind in VARIABLES[symbol].kinds
    }


def main() -> None:
    trt = "TRT as described in Section 3 of Lanese et al. (2022).\nWritten by tools/make_catalogue.py."
    write_text(FOLDER / "trt.toml", design_toml(PAPER_TRICYCLE.design, trt))
    for name in SIX_BARS:
        result = identify(load_design(name, "printed"), table1()[name])
        if not result.feasible:
            raise SystemExit(f"{name}: no dimensions inside the rounding of Table 2 satisfy Table 1")
        design = with_lengths(result.design, np.round(lengths(result.design), DIGITS))
        ranges = joint_ranges(design)
        comment = (
            f"{name.upper()} of Lanese et al. (2022), identified: inside the rounding of Table 2, closest to it,\n"
            f"with the joint ranges of Table 1 (knee {ranges[0]:.1f} to {ranges[1]:.1f}, "
            f"hip {ranges[2]:.1f} to {ranges[3]:.1f} deg).\nWritten by tools/make_catalogue.py."
        )
        write_text(FOLDER / f"{name}.toml", design_toml(design, comment))
        drawn = inside_rounding(name, half_widths(name), np.random.default_rng([_SEED, *name.encode()]), DRAWS)
        with replacing(FOLDER / f"{name}-draws.npz") as temporary:
            columns: dict[str, Any] = {key: values.round(DIGITS) for key, values in drawn.items()}
            np.savez_compressed(temporary, **columns)
        print(f"{name}: largest shift {100 * abs(result.shift).max():.2f} cm, cost {result.cost:.3f}")


if __name__ == "__main__":
    main()
