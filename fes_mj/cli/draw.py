"""`fes_mj draw`: what a workshop needs of a design."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

import numpy as np
from cyclopts import Parameter
from cyclopts.validators import Number

from fes_mj.cli.options import Cadence, DesignName, Dims, Flag, MomentsOptions, Out, PrintOptions, speed_at
from fes_mj.cli.tables import heading
from fes_mj.common.console import conclude, print_table, say
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.writing import require_results, write_results
from fes_mj.linkage.clearance import SHOWN_GAP
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.plates import hole_places
from fes_mj.statics.turn import quasi_static

if TYPE_CHECKING:
    from fes_mj.statics.sizes import Build

MaterialName: TypeAlias = Literal["aluminium", "steel", "stainless"]  # those of statics.materials


def draw(
    design: DesignName,
    /,
    *,
    out: Out,
    material: MaterialName = "aluminium",
    safety: Annotated[float, Parameter(validator=Number(gte=1, lte=20))] = 2.0,
    step: Flag = False,
    rounded: Flag = False,
    cadence: Cadence | None = None,
    dims: Dims = "identified",
    whose: MomentsOptions = MomentsOptions(),
    options: PrintOptions = PrintOptions(),
) -> int:
    """Size links and pins of a design, lay them out in layers, and write what a workshop needs.

    Into the folder go links/LINK.dxf in full size, the sheet (sheet.dxf, .svg, .pdf), links.csv with every hole, and
    pin_forces.csv and link_moments.csv with the force on every pin and the bending moment along every link over a turn.
    Exit code 1 if anything that moves meets the seat or, where
    the design file has a table [frame], the wheel or the ground.

    Args:
        out: The folder; it is made if its parent exists.
        material: Of the links.
        safety: Factor against yielding and buckling.
        step: Also links/LINK.step, solid bodies; needs the extra `step`.
        rounded: Draw the design with its lengths rounded to 0.5 mm.
        cadence: Crank speed in rpm; by default the one at which the tricycle does 5.71 km/h.
    """
    require_extra("build", "shapely", "ezdxf", "matplotlib")
    if step:
        require_extra("step", "OCP")
    loaded, moments = load_design(design, dims), whose.load_moments()
    from fes_mj.drawing import folder
    from fes_mj.statics import making
    from fes_mj.statics.sizes import FORCE_POINTS, build

    if rounded:
        loaded = making.rounded(loaded)
    names = folder.names(hole_places(loaded), step)
    paths = require_results(out, names, whose.inputs(design))
    built = build(quasi_static(loaded, moments, speed_at(cadence, loaded), FORCE_POINTS), material, safety)
    files = folder.contents(built, step)
    write_results({path: files[name] for path, name in zip(paths, names, strict=True)})
    options.show(lambda: _content(built) | {"files": [str(path) for path in paths]}, lambda: _print(built), folder=out)
    return 1 if built.stack.side.hindrances else 0


def _content(build: Build) -> dict[str, Any]:
    """The result as JSON names and units it."""
    from fes_mj.statics.making import nearest_gears, rounded, sensitivity

    side, turn = build.stack.side, build.turn
    power, becomes = None, "turns"
    try:
        power = quasi_static(rounded(turn.design), turn.moments, turn.cadence).power_mean
    except InputError as error:
        becomes = str(error)
    clearances = {gap.pair: gap.distance for gap in side.gaps}
    return {
        "design": build.design.name,
        "group": turn.moments.name,
        "power_mean_W": turn.power_mean,
        "material": build.material.name,
        "clearance_min_m": clearances | {" - ".join(pair): None for pair in side.unknown},
        "clearance_crank_angle_deg": {gap.pair: np.degrees(gap.crank_angle) for gap in side.gaps},
        "hindrances": [gap.pair for gap in side.hindrances],
        "layers": build.stack.layers,
        "between_feet_m": build.stack.feet,
        "width_m": {body: plate.width for body, plate in build.plates.items()},
        "thickness_m": {body: plate.thickness for body, plate in build.plates.items()},
        "mass_kg": build.mass,
        "pin_diameter_m": build.pins,
        "pin_force_max_N": {joint: build.loads.largest(joint) for joint in build.pins},
        "sensitivity_per_0.1_mm": [effect._asdict() for effect in sensitivity(build.design, turn.moments)],
        "rounded_power_mean_W": power,
        "rounded": becomes,
        "gears": nearest_gears(build.design.linkage.gear_ratio)._asdict(),
    }


def _print(build: Build) -> None:
    loads, side = build.loads, build.stack.side
    rows = [
        (body, *(f"{1e3 * size:g}" for size in (plate.width, plate.thickness)), f"{build.mass[body]:.3f}",
         f"{build.stack.layers[body]}")
        for body, plate in build.plates.items()
    ]  # fmt: skip
    title = f"{heading(build.turn)}; {build.material.name}"
    print_table(title, ("link", "width, mm", "thickness, mm", "mass, kg", "layer"), rows)
    cases = (loads.riding, loads.pushed)
    pins = [
        (joint.replace("_", " "), f"{1e3 * diameter:.3g}", *(f"{np.abs(case[joint]).max():.0f}" for case in cases))
        for joint, diameter in build.pins.items()
    ]
    print_table("Pins", ("joint", "diameter, mm", "riding, N", "pedal load, N"), pins)
    gaps = [(gap.pair, f"{1e3 * gap.distance:.1f}", f"{np.degrees(gap.crank_angle):.0f}") for gap in side.near]
    head = f"Clearances over the turn below {1e3 * SHOWN_GAP:g} mm; negative: passing beside each other"
    print_table(head, ("pair", "least, mm", "at crank deg"), gaps)
    _print_making(_content(build), build.design.linkage.gear_ratio)
    if missing := dict.fromkeys(part for _, part in side.unknown):
        say(f"not known, as the design file says nothing of them in [frame]: {', '.join(missing)}")
    if side.hindrances:
        meeting = ", ".join(f"{gap.pair} ({1e3 * gap.distance:.1f} mm)" for gap in side.hindrances)
        conclude(False, "Cannot be built so", f": {meeting}.")
    else:
        conclude(True, "Can be built", f": feet {1e3 * build.stack.feet:.0f} mm apart.")


def _print_making(content: dict[str, Any], ratio: float) -> None:
    """What tolerances, rounding and sprockets do to the design."""
    rows = [
        (length, f"{power:+.4f}", f"{knee:+.3f}", f"{hip:+.3f}", f"{1e3 * closing:+.2f}")
        for length, power, knee, hip, closing in map(dict.values, content["sensitivity_per_0.1_mm"])
    ]
    heads = ("length", "power, W", "knee range, deg", "hip range, deg", "to a dead centre, mm")
    print_table("If a length is 0.1 mm longer", heads, rows)
    power = content["rounded_power_mean_W"]
    say(f"with lengths rounded to 0.5 mm: {content['rounded'] if power is None else f'{power:.2f} W'}")
    crank, wheel, error = content["gears"].values()
    say(f"gear ratio {ratio:g}: {crank} teeth at the crank, {wheel} at the wheel, {100 * error:+.2f} %")
