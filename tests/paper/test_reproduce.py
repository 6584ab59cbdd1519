"""results/ as committed against what `fes_mj reproduce` would write today."""

import itertools
import json
from pathlib import Path

import pytest

import fes_mj
from fes_mj.common.writing import FOLDER_RECORD
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.paper.printed import table1
from fes_mj.statics.turn import quasi_static

RESULTS = Path(__file__).parents[2] / "results"
RECORD = json.loads((RESULTS / "reproduction.json").read_text(encoding="utf-8"))


def test_committed_powers_are_todays() -> None:
    """results/reproduction.json against statics now: a change of the model must not leave the pages behind."""
    rows = RECORD["powers"]["Table 1: mean crank power"]
    assert [(row["design"].lower(), row["group"]) for row in rows] == [*itertools.product(DESIGNS, RIDER_GROUPS)]
    for row in rows:
        result = quasi_static(fes_mj.load_design(row["design"].lower()), fes_mj.load_moments(row["group"]))
        assert result.power_mean == pytest.approx(row["identified: static, W"], rel=1e-9)
        assert result.power_sd == pytest.approx(row["sd, W"], rel=1e-9)
        assert row["dynamic, W"] == pytest.approx(row["identified: static, W"], rel=5e-4)
        assert row["paper, W"] == table1()[row["design"].lower()].power[row["group"]]


def test_committed_inputs_are_todays() -> None:
    from fes_mj.common.provenance import provenance
    from fes_mj.paper.reproduce import inputs

    now = provenance(inputs())["inputs"]
    assert len(now) == len(inputs())
    assert RECORD["provenance"]["inputs"].keys() == now.keys()
    changed = [name for name, value in now.items() if RECORD["provenance"]["inputs"][name] != value]
    assert not changed, f"run `fes_mj reproduce` again: {changed} changed"


def test_committed_pages_and_figures_are_small_and_complete() -> None:
    from fes_mj.paper.figures import FIGURES

    files = [*(RESULTS / "figures").iterdir()]
    assert {path.name for path in files} == {f"{name}.png" for name in FIGURES} | {FOLDER_RECORD}
    assert all(path.stat().st_size < 300_000 for path in files)
