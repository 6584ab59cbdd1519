"""Everything that the page can ask for: a question and what it says in, what is shown out. No browser, no network."""

import json
from collections.abc import Callable, Mapping
from functools import partial
from operator import call
from pathlib import Path
from typing import Any

from fes_mj.common.errors import InputError
from fes_mj.common.reading import Section, is_number, is_text
from fes_mj.common.style import COLOURS, MOMENTS
from fes_mj.explore.dimensions import content_of, design_of, dimensions, of_kind
from fes_mj.explore.making import making
from fes_mj.explore.numbers import by_muscles, numbers, require_muscles
from fes_mj.explore.pose import plane
from fes_mj.explore.runs import BY_MUSCLES, RUNS
from fes_mj.explore.turn import turn
from fes_mj.explore.uploads import Uploads, moments_of_bundle, read_upload
from fes_mj.linkage.design import ARCHITECTURES, BRANCHES, SEXES, Design
from fes_mj.linkage.design_file import DESIGNS, design_toml, load_design
from fes_mj.linkage.legs import LEGS
from fes_mj.linkage.riders import populations
from fes_mj.linkage.turning import turning
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.muscles.drive import Muscles, load_muscles
from fes_mj.optimization.limits import load_limits
from fes_mj.riding.ride import TRANSMISSIONS
from fes_mj.simulation.export import mjcf_text
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.statics.drive import Drive

Reply = dict[str, Any]
DRIVES = ("moments", "muscles")
MOST_SLOPE = 30.0  # percent, up or down, that a ride is asked for


class Answers:
    """What pages can ask, by name, of one design to begin with, the joint moments that are known, and what drives.

    A question is a JSON object: "page", whose uploads it means, "design" as dimensions.content_of, "moments" by name,
    "legs"; or a file as uploads.read_upload. Every answer may raise InputError.
    """

    def __init__(self, design: Design, moments: JointMoments, drive: str = DRIVES[0]) -> None:
        self.design, self.chosen, self.drive = design, moments.name, drive
        self.shared = {group: load_moments(group) for group in RIDER_GROUPS} | {moments.name: moments}
        self.uploads = Uploads()
        self.reader: Callable[..., Any] = call  # a server's reads elsewhere
        names = ("start", "turn", "making", "numbers", "change", "save", "model", "open-design", "open-moments")
        self.by_name: dict[str, Callable[[Section], Reply]] = {
            name: getattr(self, name.replace("-", "_")) for name in names
        }

    def start(self, question: Section) -> Reply:
        """What the page needs once."""
        designs = {name: content_of(load_design(name)) for name in DESIGNS}
        return {
            "designs": designs | {self.design.name: content_of(self.design)},
            "design": self.design.name,
            "dimensions": dimensions(),
            "moments": [*self._moments(question)],
            "chosen": self.chosen,
            "drive": self.drive,
            "space": plane(load_limits().polygon),
            "series": MOMENTS,
            "colours": COLOURS,
        }

    def turn(self, question: Section) -> Reply:
        """Motion, curves and numbers of a design under all moments that the page knows."""
        return turn(_design(question), self._moments(question), _legs(question))

    def making(self, question: Section) -> Reply:
        """Whether a design can be laid out and what comes near to what, sized for its turn under "moments"."""
        moments = self._moments(question)
        return making(_design(question), moments[question.choice("moments", moments)])

    def numbers(self, question: Section) -> Reply:
        """Both numbers of a design beside those of the one it is "compared" with; under muscles also what these do."""
        choices = self._moments(question)
        design, moments = _design(question), choices[question.choice("moments", choices)]
        both = numbers(design, design_of(question.content.get("compared")), moments)
        by_moments = question.choice("drive", DRIVES, DRIVES[0]) == "moments"
        return both if by_moments else both | by_muscles(design, moments, _legs(question))

    def change(self, question: Section) -> Reply:
        """A design of another "kind" or "branch", or with the rider of a "percentile" of a "sex"; as it is without."""
        design = _design(question)
        design = of_kind(design, question.choice("kind", ARCHITECTURES, design.linkage.kind))
        design = design.with_linkage(branch=question.choice("branch", BRANCHES, design.linkage.branch))
        if "percentile" in question.content:
            sex = question.choice("sex", SEXES, design.rider.sex)
            percentile = question.number("percentile", 1, 99, "a percentile from 1 to 99")
            rider = next(people for people in populations().values() if people.sex == sex).rider(percentile)
            design = design.with_rider(thigh=rider.thigh, shank=rider.shank, mass=rider.mass, sex=sex)
        return {"design": content_of(design)}

    def save(self, question: Section) -> Reply:
        """A design as the text of its file."""
        design = _design(question)
        return {"name": f"{design.name}.toml", "text": design_toml(design, "Made with fes_mj explore.")}

    def model(self, question: Section) -> Reply:
        """The MuJoCo model of a design."""
        design = _design(question)
        return {"name": f"{design.name}.xml", "text": mjcf_text(build_mjcf(design, legs=_legs(question)))}

    def open_design(self, question: Section) -> Reply:
        """A design file's design."""
        return {"design": content_of(read_upload(question, load_design, self.reader))}

    def open_moments(self, question: Section) -> Reply:
        """Take a file of joint moments, with those that it names, among the ones that the page knows."""
        moments = read_upload(question, moments_of_bundle, self.reader)
        name = self.uploads.add(_page(question), moments, self.shared)
        warnings = [misreading.text for misreading in moments.misreadings]
        return {"name": name, "moments": [*self._moments(question)], "warnings": warnings}

    def run(self, name: str, question: Section) -> Callable[[Path], Reply]:
        """What runs.RUNS is asked, with all that it needs, but for its folder. Raises InputError, and KeyError."""
        design, drive = _design(question), self._drive(question)
        if isinstance(drive, Muscles) and name not in BY_MUSCLES:
            raise InputError("muscles do not drive this; choose joint moments")
        if name != "fit":  # which may find a seat with which it turns
            turning(design)
        options: Mapping[str, Callable[[], Reply]] = {
            "simulate": lambda: {"legs": _legs(question)},
            "ride": lambda: {
                "transmission": question.choice("transmission", TRANSMISSIONS, TRANSMISSIONS[0]),
                "slope": question.value("slope", 0.0, _is_slope, f"a slope from -{MOST_SLOPE:g} to {MOST_SLOPE:g} %"),
            },
        }
        return partial(RUNS[name], design, drive, **options.get(name, dict)())

    def _drive(self, question: Section) -> Drive:
        """What drives: the moments that are asked for, or the muscles of the same riders."""
        choices = self._moments(question)
        moments = choices[question.choice("moments", choices)]
        if question.choice("drive", DRIVES, DRIVES[0]) == "moments":
            return moments
        require_muscles(moments.name)
        return load_muscles(moments.name)

    def _moments(self, question: Section) -> dict[str, JointMoments]:
        return self.shared | self.uploads.of(_page(question))


def as_question(body: bytes) -> Section:
    """What a page has sent, to be read key by key. Raises InputError unless it is a JSON object."""
    try:
        content = json.loads(body)
    except (ValueError, RecursionError):
        content = None
    if not isinstance(content, dict):
        raise InputError("a question must be a JSON object")
    return Section(Path("the page"), "", content)


def _page(question: Section) -> str:
    return str(question.value("page", "", is_text, "the page's own name"))


def _design(question: Section) -> Design:
    return design_of(question.content.get("design"))


def _is_slope(value: Any) -> bool:
    return is_number(value) and abs(value) <= MOST_SLOPE


def _legs(question: Section) -> int:
    allowed = " or ".join(map(str, LEGS))
    return int(question.value("legs", 1, lambda legs: isinstance(legs, int) and legs in LEGS, allowed))
