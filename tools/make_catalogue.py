"""Write fes_mj/data/designs/identified from the printed dimensions and Table 1's joint ranges."""

from fes_mj.design_file import design_toml, load_design
from fes_mj.files import write_text
from fes_mj.geometry import joint_ranges
from fes_mj.paper.identification import identify, rounded
from fes_mj.paper.printed import DATA, SIX_BARS, table1
from fes_mj.reference_tricycle import PAPER_TRICYCLE

FOLDER = DATA / "designs" / "identified"


def main() -> None:
    trt = "TRT as described in Section 3 of Lanese et al. (2022).\nWritten by tools/make_catalogue.py."
    write_text(FOLDER / "trt.toml", design_toml(PAPER_TRICYCLE.design, trt))
    for name in SIX_BARS:
        result = identify(load_design(name, "printed"), table1()[name])
        if not result.feasible:
            raise SystemExit(f"{name}: no dimensions inside the rounding of Table 2 satisfy Table 1")
        design = rounded(result.design)
        ranges = joint_ranges(design)
        comment = (
            f"{name.upper()} of Lanese et al. (2022), identified: inside the rounding of Table 2, closest to it,\n"
            f"with the joint ranges of Table 1 (knee {ranges[0]:.1f} to {ranges[1]:.1f}, "
            f"hip {ranges[2]:.1f} to {ranges[3]:.1f} deg).\nWritten by tools/make_catalogue.py."
        )
        write_text(FOLDER / f"{name}.toml", design_toml(design, comment))
        print(f"{name}: largest shift {100 * abs(result.shift).max():.2f} cm, cost {result.cost:.3f}")


if __name__ == "__main__":
    main()
