"""Design files: TOML in metres and degrees, read and written; the paper's designs are a folder of them."""

import math
from dataclasses import fields, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError, require_one_of
from fes_mj.common.reading import DATA, Section, is_list, is_number, read_toml
from fes_mj.common.text import printable
from fes_mj.linkage.design import ARCHITECTURES, BRANCHES, SEXES, Design, Frame, Linkage, Rider
from fes_mj.linkage.riders import PRESETS, preset
from fes_mj.linkage.variables import LONGEST, SHORTEST, VARIABLES, Variable, nearest_degrees

SIX_BARS = ("r1", "r2", "d1", "d2")
DESIGNS = ("trt", *SIX_BARS)
DIMENSIONS = ("identified", "printed")
_FOLDER = DATA / "designs"


def load_design(source: str | Path, dims: str = "identified") -> Design:
    """A design of the paper ("trt", "r1", "r2", "d1", "d2"; dims "identified" or "printed") or a design file.

    Raises InputError naming the file, the key, the value and what is allowed.

    >>> design = fes_mj.load_design("d1")
    >>> design.linkage.kind, design.linkage.crank
    ('cdt', 0.160788)
    """
    path = design_path(source, dims)
    return _catalogued(path) if source in DESIGNS else _read(path)


@cache
def _catalogued(path: Path) -> Design:
    return _read(path)


def _read(path: Path) -> Design:
    return read_design(read_toml(path, "design file"), printable(path.stem))


def design_path(source: str | Path, dims: str = "identified") -> Path:
    """The file that load_design reads. Raises InputError for a name that is neither a design's nor a file's."""
    require_one_of("dims", dims, DIMENSIONS)
    if source in DESIGNS:
        return _FOLDER / dims / f"{source}.toml"
    path = Path(source)
    if dims != DIMENSIONS[0]:
        raise InputError(f"{source}: only the paper's designs have {dims} dimensions; leave out dims for a file")
    if path.suffix != ".toml" and (len(str(source)) > 255 or "\0" in str(source) or not path.exists()):
        raise InputError(f"{source}: no such design; it must be one of {', '.join(DESIGNS)} or a path to a .toml file")
    return path


def identified_draws(name: str) -> dict[str, FloatArray]:
    """What identification leaves open of a six-bar of the paper: linkages by component (variables), in units of files.

    Shape (linkages,) each, drawn evenly; empty for any other name. Written by tools/make_catalogue.py.
    """
    path = _FOLDER / "identified" / f"{name}-draws.npz"
    if name not in DESIGNS or not path.exists():
        return {}
    with np.load(path) as stored:
        return {component: np.asarray(stored[component]) for component in stored}


def read_design(content: Section, name: str) -> Design:
    """A design from the content of a design file. Raises InputError as load_design."""
    if "kind" in content.content:
        raise InputError(f"{content.path}: kind = ... stands above all tables; put [linkage] before it")
    content.only(("linkage", "rider", "frame"))
    linkage = content.section("linkage")
    if isinstance(linkage.content.get("rider"), str):
        raise InputError(f"{content.path}: rider = ... stands in [linkage]; move it above the first table")
    kind = linkage.choice("kind", ARCHITECTURES)
    words = ("kind",) if kind == "trt" else ("kind", "branch")
    numbers = read_values(linkage, kind, *words)
    branch = linkage.choice("branch", BRANCHES, Linkage.branch)
    return Design(name, Linkage(kind, **numbers, branch=branch), _rider(content, kind), read_frame(content))


def read_frame(content: Section) -> Frame:
    """What a table [frame] says; of the tube and the wheel all or nothing."""
    table = content.section("frame")
    values: dict[str, Any] = {}
    table.only(field.name for field in fields(Frame))
    for key in table.content:
        if key in ("tube", "wheel_centre"):
            count = 2 if key == "tube" else 1
            points = table.content[key] if key == "tube" else [table.content[key]]
            if not is_list(points, lambda point: is_list(point, _reachable, 2), count):
                table.refuse(key, table.content[key], f"{'two points' if count == 2 else 'a point'} [x, y] in metres")
            ends = tuple(complex(*point) for point in points)
            values[key] = ends if key == "tube" else ends[0]
        else:
            low = SHORTEST if key.endswith("diameter") else -LONGEST
            values[key] = table.number(key, low, LONGEST, f"a length in metres from {low:g} to {LONGEST:g}")
    for one, other in (("tube", "tube_diameter"), ("wheel_centre", "wheel_diameter")):
        if (one in values) != (other in values):
            table.require([one, other], "of a tube and of a wheel both the place and the diameter are needed")
    return Frame(**values)


def _reachable(value: object) -> bool:
    return is_number(value) and abs(float(str(value))) <= LONGEST


def _rider(content: Section, kind: str) -> Rider:
    """Of a table [rider] or, by `rider = "NAME"` above all tables, a preset."""
    named = content.content.get("rider", {})
    if isinstance(named, dict):
        return read_rider(content.section("rider"), kind, Rider())
    rider = preset(named)
    if not rider:
        content.refuse("rider", named, f"a table [rider], or the name of a rider: {PRESETS}")
    return rider


def read_rider(section: Section, kind: str, default: Rider) -> Rider:
    """The rider of a table, `default` where it says nothing."""
    sex = section.choice("sex", SEXES, default.sex)
    return replace(default, sex=sex, **read_values(section, kind, "sex", owner="rider"))


def read_values(section: Section, kind: str, *others: str, owner: str = "", partial: bool = False) -> dict[str, Any]:
    """Attributes in SI and radians of a table, every key checked; `others` are its keys that somebody else reads.

    owner: "linkage" or "rider", whose variables they are, if that is not the table's name. partial: nothing is needed.
    """
    variables = _variables(owner or section.name, kind)
    section.only((*variables, *others))
    for symbol, variable in variables.items():
        if variable.needed and not partial:
            section.require([symbol], f"a {kind} needs {variable.allowed}")
    return {v.attribute: _value(section, v) for symbol, v in variables.items() if symbol in section.content}


def _variables(owner: str, kind: str) -> dict[str, Variable]:
    return {symbol: v for symbol, v in VARIABLES.items() if v.owner == owner and kind in v.kinds}


def _value(section: Section, variable: Variable) -> float | complex:
    value = section.content[variable.symbol]
    parts = value if isinstance(value, list) else [value]
    numbers = all(is_number(part) for part in parts)
    shaped = isinstance(value, list) == variable.vector and len(parts) == (2 if variable.vector else 1)
    if not (numbers and shaped and all(variable.accepts(part) for part in parts)):
        metres = variable.unit == "m" and numbers and any(LONGEST < abs(part) < math.inf for part in parts)
        hint = " (centimetres? lengths are in metres)" if metres else ""
        section.refuse(variable.symbol, value, variable.allowed + hint)
    if variable.vector:
        return complex(*parts)
    return math.radians(parts[0]) if variable.unit == "deg" else float(parts[0])


def design_toml(design: Design, comment: str = "") -> str:
    """The text of a design file that reads back as `design`; `comment` goes above it, a line each.

    An angle that no degrees are read as becomes its neighbour, which is written the same again.
    """
    kind = design.linkage.kind
    lines = [f"# {line}".rstrip() for line in comment.splitlines()]
    for table, owner, head in (
        ("linkage", design.linkage, f'kind = "{kind}"'),
        ("rider", design.rider, f'sex = "{design.rider.sex}"'),
    ):
        lines += [f"[{table}]", head]
        if owner is design.linkage and design.linkage.branch != Linkage.branch:
            lines.append(f'branch = "{design.linkage.branch}"')
        for symbol, variable in _variables(table, kind).items():
            value = getattr(owner, variable.attribute)
            if not (variable.implied and value == getattr(type(owner), variable.attribute)):
                lines.append(f"{symbol} = {_written(value, variable)}")
    frame = {name: value for name, value in vars(design.frame).items() if value is not None}
    lines += ["[frame]"] * bool(frame) + [f"{name} = {_plain(value)}" for name, value in frame.items()]
    return "\n".join(lines) + "\n"


def _plain(value: float | complex | tuple[complex, ...]) -> str:
    """A number, a point or several as TOML."""
    if isinstance(value, tuple):
        return f"[{', '.join(map(_plain, value))}]"
    return f"[{value.real!r}, {value.imag!r}]" if isinstance(value, complex) else repr(float(value))


def _written(value: Any, variable: Variable) -> str:
    """Shortest decimal that reads back as the same number; of an angle as nearest_degrees."""
    if variable.vector:
        return f"[{float(value.real)!r}, {float(value.imag)!r}]"
    if variable.unit != "deg":
        return repr(float(value))
    as_read = math.radians(nearest_degrees(value))
    degrees = nearest_degrees(as_read)
    for digits in range(12, 17):
        text = np.format_float_positional(degrees, precision=digits, fractional=False, trim="0")
        if math.radians(float(text)) == as_read:
            return text
    return repr(degrees)
