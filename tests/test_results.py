"""results/ says what the code of today says: made again, every page has the same words and the same numbers."""

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

from fes_mj import load_design, load_moments, quasi_static
from fes_mj.cli.app import run
from fes_mj.common.checks import definitions
from fes_mj.common.units import RPM
from fes_mj.simulation.time_step import steps_per_turn
from studies.time_step import CADENCES

RESULTS = Path(__file__).parents[1] / "results"
MACHINE = re.compile(r' *"(command|python)": ')
NUMBER = re.compile(r"[+-]?\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?")


@pytest.mark.long
def test_everything_about_the_paper_is_written_again(tmp_path: Path) -> None:
    assert run(["reproduce", "-q", "--out", str(tmp_path)]) == 0
    written = {path.relative_to(tmp_path) for path in tmp_path.rglob("[!.]*") if path.is_file()}
    committed = {path.relative_to(RESULTS) for path in (RESULTS / "figures").glob("[!.]*")}
    assert committed <= written
    for name in written - committed:
        assert (RESULTS / name).exists(), f"results/{name} is not committed"
        same_text((tmp_path / name).read_text(encoding="utf-8"), (RESULTS / name).read_text(encoding="utf-8"), name)


def same_text(new: str, old: str, name: Path) -> None:
    """The same words, and numbers within 1 % (optimisers end a little apart on other machines).

    Neither the command nor the release of Python need be the same: results do not depend on them.
    """
    for number, (one, other) in enumerate(zip(new.splitlines(), old.splitlines(), strict=True), 1):
        if one != other and not MACHINE.match(one):
            assert NUMBER.split(one) == NUMBER.split(other), f"results/{name}, line {number}"
            values = ([float(text.replace(",", "")) for text in NUMBER.findall(line)] for line in (one, other))
            assert next(values) == pytest.approx(next(values), rel=0.01, abs=0.01), f"results/{name}, line {number}"


def test_a_page_that_is_behind_is_noticed() -> None:
    same_text("mean 31.12 W", "mean 31.13 W", Path("page"))
    same_text('  "python": "3.11.2",', '  "python": "3.11.7",', Path("page"))
    for behind in ("mean 35.9 W", "mean 31.12 J", "mean power 31.12 W"):
        with pytest.raises(AssertionError, match="results/page, line 1"):
            same_text("mean 31.12 W", behind, Path("page"))


def test_the_verification_has_todays_checks_and_limits() -> None:
    checks = json.loads((RESULTS / "verification.json").read_text(encoding="utf-8"))["checks"]
    rows = {name: row for name, row in definitions().items() if not name.startswith("muscle_")}  # of another page
    stated = {name: (row.kind, row.limit, row.unit) for name, row in rows.items()}
    assert {check["name"]: (check["kind"], check["limit"], check["unit"]) for check in checks} == stated


@pytest.mark.long
def test_the_verification_has_todays_values(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["validate", "d1", "--group", "p1p2", "--quick", "--json"]) == 0
    record = json.loads((RESULTS / "verification.json").read_text(encoding="utf-8"))
    old = {(check["name"], check["subject"]): check["value"] for check in record["checks"]}
    for check in json.loads(capsys.readouterr().out)["checks"]:
        if check["value"] > 1e-3 * check["limit"]:  # what is not rounding
            assert check["value"] == pytest.approx(old[check["name"], check["subject"]], rel=0.02), check["name"]


def test_the_found_designs_have_the_power_they_are_listed_with() -> None:
    winners: list[dict[str, Any]] = json.loads(
        (RESULTS / "optimization" / "comparison.json").read_text(encoding="utf-8")
    )["winners"]
    for winner in winners:
        design = load_design(RESULTS / "optimization" / f"{winner['target']}-caution-{winner['caution']:.0f}.toml")
        powers = [quasi_static(design, load_moments(group)).power_mean for group in ("p1p2", "p1p3")]
        assert winner["power_mean_W"] == pytest.approx(max(powers, key=lambda p: -abs(p - winner["power_mean_W"])))
        assert winner["timestep_s"] == pytest.approx(
            2 * math.pi / design.linkage.cadence / steps_per_turn(design, design.linkage.cadence), rel=1e-6
        )


@pytest.mark.long
def test_the_page_on_the_time_step_has_todays_steps() -> None:
    rows = (RESULTS / "time_step.md").read_text(encoding="utf-8").split("## Steps a turn")[1]
    for name, files in (
        ("paper", ["trt", "r1", "r2", "d1", "d2"]),
        ("optimised", sorted((RESULTS / "optimization").glob("*.toml"))),
    ):
        steps = [steps_per_turn(load_design(file), rpm * RPM) for file in files for rpm in CADENCES]
        assert re.search(rf"\| {name} .*\| +{max(steps)} \|", rows), f"{name}: {max(steps)}"
