"""Published measurements, data/published.toml, each beside what is predicted of it blind."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from types import ModuleType
from typing import Any, TypeAlias

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import DATA, read_toml
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.validation import by_angle, cranking, machines, roads
from fes_mj.validation.cranking import CrankingSetup

PUBLISHED_FILE = DATA / "published.toml"
AGREES, CONTRADICTS, CANNOT_TELL = VERDICTS = ("agrees", "contradicts", "cannot tell")
RULE = (
    "The prediction's interval holds 90 % of the riders who may have been measured. A direction agrees if all of it "
    "lies on that side and contradicts if none does. A number contradicts if the two intervals do not overlap; it "
    "agrees if either interval holds the middle of the other and the prediction's is at most three times as wide as "
    "the measurement's, so that it could have failed. Anything else cannot tell."
)
_ENDS = (0.05, 0.5, 0.95)
_WIDEST = 3.0  # prediction's interval per the measurement's
_MODULES: tuple[ModuleType, ...] = (by_angle, cranking, machines, roads)
Interval: TypeAlias = tuple[float, float]
Prediction: TypeAlias = Callable[[Riders, CrankingSetup], FloatArray]


def interval_verdict(predicted: tuple[float, float, float], measured: Interval) -> str:
    """By RULE; predicted: low end, middle and high end. measured: a direction has an infinite end."""
    low, middle, high = predicted
    least, most = measured
    if high <= least or low >= most:
        return CONTRADICTS
    if math.isinf(most - least):
        return AGREES if least <= low and high <= most else CANNOT_TELL
    near = least <= middle <= most or low <= (least + most) / 2 <= high
    return AGREES if near and high - low <= _WIDEST * (most - least) else CANNOT_TELL


@dataclass(frozen=True)
class PublishedRow:
    """One row of the file, whose keys it describes."""

    content: dict[str, Any]

    @property
    def name(self) -> str:
        return str(self.content["name"])

    @property
    def measured(self) -> Interval:
        """Ends, of a direction one of them infinite."""
        if "measured" in self.content:
            low, high = self.content["measured"]
            return float(low), float(high)
        return float(self.content.get("above", -math.inf)), float(self.content.get("below", math.inf))

    @cached_property
    def values(self) -> FloatArray:
        """Predicted, of every rider."""
        predict, setup = prediction(self.content["predicted_by"]), self.content.get("setup", {})
        return np.concatenate([predict(load_riders(group), setup) for group in self.content["riders"]])

    @cached_property
    def predicted(self) -> tuple[float, float, float]:
        """Low end, middle and high end."""
        low, middle, high = (float(value) for value in np.quantile(self.values, _ENDS))
        return low, middle, high

    @property
    def verdict(self) -> str:
        return interval_verdict(self.predicted, self.measured)

    def record(self) -> dict[str, Any]:
        """As JSON names it; ends of the measurement are None where it has none."""
        ends = [None if math.isinf(end) else end for end in self.measured]
        texts = ("question", "quantity", "unit", "drive", "timing", "riders", "assumed", "source", "said")
        kept = {key: self.content[key] for key in texts}
        unless = self.content.get("unless", "") if self.verdict == CONTRADICTS else ""
        numbers = {"predicted": [*self.predicted], "measured": ends, "verdict": self.verdict, "unless": unless}
        return {"name": self.name, "kind": self.content["kind"]} | kept | numbers


def prediction(name: str) -> Prediction:
    """The function of this name."""
    function: Prediction = next(getattr(module, name) for module in _MODULES if hasattr(module, name))
    return function


@cache
def rows() -> tuple[PublishedRow, ...]:
    """All of the file, measurements first."""
    unsorted = [PublishedRow(content) for content in read_toml(PUBLISHED_FILE, "published measurements").content["row"]]
    return tuple(sorted(unsorted, key=lambda row: row.content["kind"] != "measurement"))


def counts(records: list[dict[str, Any]]) -> dict[str, int]:
    """How many measurements have each verdict."""
    verdicts = [record["verdict"] for record in records if record["kind"] == "measurement"]
    return {verdict: verdicts.count(verdict) for verdict in VERDICTS}
