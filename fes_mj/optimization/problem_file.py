"""The problem that is solved as a problem file, with the comments of the one that is shipped."""

import json
import re

from fes_mj.common.text import printable
from fes_mj.linkage.variables import nearest_degrees
from fes_mj.optimization.buildable import KEYS
from fes_mj.optimization.limits import DEFAULT, VARIED, Limits
from fes_mj.optimization.problem import Problem

_LINE = re.compile(r"^(\w+) = [^#\n]*?( *#.*)?$", re.MULTILINE)


def problem_text(problem: Problem) -> str:
    """A problem file that is read as the problem's limits, below what the options and the design say, as comments."""
    template, values = problem.template, _values(problem.limits)
    rider, speed = template.rider, problem.joint_speed

    def line(match: re.Match[str]) -> str:
        name, comment = match[1], match[2] or ""
        return f"{name} = {values[name]}{comment}" if name in values else f"# {match[0]}"

    head = (
        f"kind: {template.linkage.kind}; the rider of {printable(template.name)}: thigh {rider.thigh:g} m, shank "
        f"{rider.shank:g} m, {rider.mass:g} kg, {rider.sex}",
        f"seat angle {nearest_degrees(template.linkage.seat_angle):g} deg; mean joint speeds up to {speed.knee:.1f} "
        f"(knee) and {speed.hip:.1f} deg/s (hip)",
    )
    return "".join(f"# {text}\n" for text in head) + _LINE.sub(line, DEFAULT.read_text(encoding="utf-8"))


def _values(limits: Limits) -> dict[str, str]:
    """What a problem file says, by key, as TOML; what does not hold is left out."""
    numbers = {name: value for name, value in vars(limits).items() if isinstance(value, float)}
    pairs = {"knee_deg": limits.knee_deg, "hip_deg": limits.hip_deg}
    pairs |= {name: tuple(ends) for name, ends in zip(VARIED, limits.search.tolist(), strict=True)}
    vertices = ", ".join(f"[{float(point.real)!r}, {float(point.imag)!r}]" for point in limits.polygon)
    return {
        "name": json.dumps(limits.space),
        "polygon": f"[{vertices}]",
        **{name: repr(value) for name, value in numbers.items()},
        **{name: f"[{low!r}, {high!r}]" for name, (low, high) in pairs.items()},
        **({key: repr(float(getattr(limits.build, key))) for key in KEYS} if limits.build else {}),
    }
