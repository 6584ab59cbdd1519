"""Everything that the page can ask for: a question and what it says in, what is shown out. No browser, no network."""

from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TypeVar

from fes_mj.common.checks import Check
from fes_mj.common.console import number
from fes_mj.common.errors import InputError
from fes_mj.common.style import COLOURS, SERIES
from fes_mj.common.text import printable, typeset
from fes_mj.common.units import KMH
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.crosscheck.turn_case import Case
from fes_mj.explore.dimensions import content_of, design_of, dimensions
from fes_mj.explore.turn import turn
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, design_toml, load_design
from fes_mj.linkage.legs import LEGS
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import GROUPS, JointMoments
from fes_mj.moments.torque_velocity import load_torque_velocity
from fes_mj.riding.ride import Ride
from fes_mj.simulation.export import mjcf_text
from fes_mj.simulation.mjcf import build_mjcf

Loaded = TypeVar("Loaded")


class Answers:
    """What a page can ask, by name, of one design to begin with and the joint moments that are known.

    A question is a JSON object: "design" as dimensions.content_of, "moments" by name, "legs"; or a file's "name" and
    "text". Every answer may raise InputError.
    """

    def __init__(self, design: Design, moments: JointMoments) -> None:
        self.design, self.chosen = design, moments.name
        self.moments = {group: load_moments(group) for group in GROUPS} | {moments.name: moments}
        asked = (self.start, self.turn, self.save, self.model, self.simulate, self.ride)
        questions = (*asked, self.open_design, self.open_moments)
        self.by_name: dict[str, Callable[[dict[str, Any]], dict[str, Any]]] = {
            question.__name__.replace("_", "-"): question for question in questions
        }

    def start(self, _: dict[str, Any]) -> dict[str, Any]:
        """What the page needs once."""
        designs = {name: content_of(load_design(name)) for name in DESIGNS}
        return {
            "designs": designs | {self.design.name: content_of(self.design)},
            "design": self.design.name,
            "dimensions": dimensions(),
            "moments": [*self.moments],
            "chosen": self.chosen,
            "series": SERIES,
            "colours": COLOURS,
        }

    def turn(self, question: dict[str, Any]) -> dict[str, Any]:
        """Motion, curves and numbers of a design under all known moments."""
        return turn(design_of(question.get("design")), self.moments, _legs(question))

    def save(self, question: dict[str, Any]) -> dict[str, Any]:
        """A design as the text of its file."""
        design = design_of(question.get("design"))
        return {"name": f"{design.name}.toml", "text": design_toml(design, "Made with fes_mj explore.")}

    def model(self, question: dict[str, Any]) -> dict[str, Any]:
        """The MuJoCo model of a design."""
        design, legs = design_of(question.get("design")), _legs(question)
        return {"name": f"{design.name}.xml", "text": mjcf_text(build_mjcf(design, legs=legs))}

    def simulate(self, question: dict[str, Any]) -> dict[str, Any]:
        """A run in MuJoCo beside statics. Raises UnstableError too."""
        return simulated(design_of(question.get("design")), self._moments(question), _legs(question))

    def ride(self, question: dict[str, Any]) -> dict[str, Any]:
        """A ride on the flat by two solvers, which takes a while. Raises UnstableError too."""
        return ridden(design_of(question.get("design")), self._moments(question))

    def open_design(self, question: dict[str, Any]) -> dict[str, Any]:
        """A design file's design."""
        return {"design": content_of(_read(question, load_design))}

    def open_moments(self, question: dict[str, Any]) -> dict[str, Any]:
        """Take a file of joint moments among the known ones."""
        moments = _read(question, load_moments)
        if moments.name in GROUPS:
            raise InputError(f"{moments.name} is the name of a group; give the file of moments another name")
        self.moments[moments.name] = moments
        return {
            "name": moments.name,
            "moments": [*self.moments],
            "warnings": [misreading.text for misreading in moments.misreadings],
        }

    def _moments(self, question: dict[str, Any]) -> JointMoments:
        name = question.get("moments")
        if name not in self.moments:
            raise InputError(f"moments is {name!r}; it must be one of {', '.join(self.moments)}")
        return self.moments[name]


def _legs(question: dict[str, Any]) -> int:
    legs = question.get("legs", 1)
    if legs not in LEGS:
        raise InputError(f"legs is {legs!r}; it must be one of {', '.join(map(str, LEGS))}")
    return int(legs)


def _read(question: dict[str, Any], load: Callable[[str], Loaded]) -> Loaded:
    """What a file of the page's user holds, read as a file on this machine is."""
    name, text = question.get("name"), question.get("text")
    if not isinstance(name, str) or not isinstance(text, str):
        raise InputError("the page sent no file; it must have a name and a text")
    with TemporaryDirectory() as folder:
        path = Path(folder) / printable(Path(name).name)[-100:]
        path.write_text(text, encoding="utf-8")
        try:
            return load(str(path))
        except InputError as error:
            raise InputError(str(error).replace(f"{path.parent}/", "")) from None


def simulated(design: Design, moments: JointMoments, legs: int) -> dict[str, Any]:
    """As `fes_mj simulate`: the verdict in a sentence, and every check. Raises what Case raises."""
    case = Case(design, moments, legs=legs)
    power = (
        f"mean power {case.simulation.power_mean:.2f} W against {case.statics.power_mean:.2f} W, {case.difference_text}"
    )
    return _outcome("Dynamic and static", power, case.checks)


def ridden(design: Design, moments: JointMoments) -> dict[str, Any]:
    """As `fes_mj ride` on the flat, in the same form. Raises what RideCase raises."""
    case = RideCase(Ride(design, moments.at_speed(load_torque_velocity("hill"))))
    trace = case.simulation.trace
    result = f"it stops after {trace.stopped_at:.1f} s" if trace.stopped_at is not None else "it rides"
    if trace.mean_speed is not None:
        result += f", {trace.mean_speed / KMH:.2f} km/h at the end"
    return _outcome("The two solvers", result, case.checks)


def _outcome(who: str, result: str, checks: Sequence[Check]) -> dict[str, Any]:
    """Of checks that hold together or not; the page shows `verdict` and a table."""
    failed = ", ".join(check.name for check in checks if not check.ok)
    verdict = f"{who} do not agree ({failed}): {result}." if failed else f"{who} agree: {result}."
    rows = [
        {
            "name": check.name.replace("_", " "),
            "value": number(check.value, check.unit),
            "limit": number(check.limit, check.unit),
            "ok": bool(check.ok),
        }
        for check in checks
    ]
    return {"agrees": not failed, "verdict": typeset(verdict), "checks": rows}
