"""A design as the page holds it, the content of a design file; and its sliders, from the table of variables."""

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

from fes_mj.common.errors import InputError
from fes_mj.common.reading import Section
from fes_mj.common.text import printable
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Design, Linkage
from fes_mj.linkage.design_file import DESIGNS, design_toml, load_design, read_design
from fes_mj.linkage.variables import COMPONENTS, SIX_BAR, VARIABLES, Component, component, crank_speed

# Unit of files -> unit of the page, how many of it, how far a slider goes to either side, its step (page's unit).
_SCALES: dict[str, tuple[str, float, float, float]] = {
    "m": ("cm", 100.0, 15.0, 0.1),
    "deg": ("deg", 1.0, 45.0, 0.5),
    "": ("", 1.0, 1.0, 0.01),
    "kg": ("kg", 1.0, 40.0, 1.0),
}


def content_of(design: Design) -> dict[str, Any]:
    """What a design file of the design says, with every variable that it may leave out, and its name."""
    content = tomllib.loads(design_toml(design))
    for symbol, variable in VARIABLES.items():
        if variable.owner and design.linkage.kind in variable.kinds and not variable.vector:
            content[variable.owner].setdefault(symbol, component(design, symbol))
    return {"name": design.name, **content}


def design_of(content: Any) -> Design:
    """The design again. Raises InputError as design_file.load_design, and for a cadence that no command runs."""
    if not isinstance(content, dict) or not isinstance(content.get("name"), str):
        raise InputError("the page asked about no design; it must send one with a name")
    tables = {key: value for key, value in content.items() if key != "name"}
    name = printable(content["name"])
    design = read_design(Section(Path(name), "", tables), name)
    crank_speed(design)
    return design


def of_kind(design: Design, kind: str) -> Design:
    """The design as another kind of linkage: what both kinds have stays, and the crank's place; the rest is a paper's.

    The paper's is its first design of that kind.
    """
    linkage = next(paper.linkage for paper in map(load_design, DESIGNS) if paper.linkage.kind == kind)
    both = {design.linkage.kind, kind}
    kept = [v.attribute for v in VARIABLES.values() if v.owner == "linkage" and both <= {*v.kinds}]
    if both <= {*SIX_BAR}:
        kept.append("branch")
    linkage = replace(linkage, **{attribute: getattr(design.linkage, attribute) for attribute in kept})
    return replace(design, linkage=replace(linkage, ground=design.linkage.crank_centre - linkage.pivot_to_crank))


def dimensions() -> list[dict[str, Any]]:
    """Every number of a design: its place in `content_of`, name, unit, bounds and slider, in the page's units."""
    return [_dimension(name, part) for name, part in COMPONENTS.items() if part.variable.owner]


def _dimension(name: str, component: Component) -> dict[str, Any]:
    variable = component.variable
    unit, factor, reach, step = _SCALES[variable.unit]
    low, high = variable.low, variable.high
    if name == "gear_ratio":  # also a cadence that can be run
        cadence, of_one = VARIABLES["cadence_rpm"], Linkage("trt", 0j, 0.0, 0.0, gear_ratio=1.0).cadence / RPM
        low, high = max(low, cadence.low / of_one), min(high, cadence.high / of_one)
    return {
        "name": name,
        "owner": variable.owner,
        "symbol": variable.symbol,
        "part": {"": None, "real": 0, "imag": 1}[component.part],
        "words": variable.attribute.replace("_", " "),
        "kinds": variable.kinds,
        "unit": unit,
        "factor": factor,
        "low": low * factor,
        "high": high * factor,
        "reach": reach,
        "step": step,
    }
