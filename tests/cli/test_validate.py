"""`fes_mj validate` and `fes_mj explain`: verdicts, exit codes, JSON, JUnit XML, the report."""

import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest

from fes_mj.checks import Check, check, definitions, find
from fes_mj.cli.app import run
from fes_mj.errors import InputError
from fes_mj.verification.mistakes import faults


def _json(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, dict]:
    code = run([*arguments, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_every_check_of_simulate_can_be_explained(capsys: pytest.CaptureFixture[str]) -> None:
    _, content = _json(capsys, "simulate", "r1")
    for each in content["checks"]:
        assert run(["explain", each["name"]]) == 0
        assert run(["explain", each["name"].replace("_", " ").upper()]) == 0
        text = capsys.readouterr().out
        assert "guards against" in text
        assert "usually broken by" in text


def test_every_check_printed_by_simulate_is_named_as_explain_knows_it(capsys: pytest.CaptureFixture[str]) -> None:
    run(["simulate", "r1"])
    lines = capsys.readouterr().out.split("Checks")[1].splitlines()
    names = [line.split("  ")[1].strip() for line in lines if line.rstrip().endswith("ok")]
    assert len(names) >= 6
    assert set(names) <= set(definitions())


def test_explain_without_a_name_lists_all_and_an_unknown_one_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["explain"]) == 0
    text = capsys.readouterr().out
    assert all(name in text for name in definitions())
    assert run(["explain", "loopgap"]) == 2
    assert capsys.readouterr().err == "fes_mj: loopgap: no such check; did you mean loop_gap?\n"


def test_the_registry_is_complete() -> None:
    for definition in definitions().values():
        assert definition.limit >= 0
        assert (
            min(len(text) for text in (definition.quantity, definition.reason, definition.guards, definition.breaks))
            >= 12
        )
    assert find("Loop gap").name == "loop_gap"
    with pytest.raises(InputError, match="no such check; it must be one of loop_closure"):
        find("?")


def test_verdicts_on_values() -> None:
    assert check("loop_gap", 1e-5).ok
    assert not check("loop_gap", 1.1e-5).ok
    assert not check("loop_gap", float("nan")).ok
    assert check("loop_gap", 3e-5).factor == pytest.approx(3)
    assert check("loop_gap", float("nan")).factor == float("inf")
    assert check("assembly_mode", 1).factor == float("inf")
    assert Check("any", 0.0, 0.0).factor == 0


def test_validate_quick_says_that_all_is_well(capsys: pytest.CaptureFixture[str]) -> None:
    code, content = _json(capsys, "validate", "trt", "d1", "--quick")
    assert code == 0
    assert content["ok"] is True
    assert {"name", "value", "limit", "unit", "ok", "subject", "kind"} <= set(content["checks"][0])
    assert {each["subject"] for each in content["checks"]} == {"trt p1p2", "d1 p1p2", "A02", "four-bar"}
    assert all(each["ok"] for each in content["checks"])
    assert [each["design"] for each in content["runs"]] == ["trt", "d1"]
    assert "faults" not in content


def test_a_failed_check_exits_with_1_and_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fes_mj.simulation.mjcf.LOOP_SOLREF", (0.02, 1.0))
    assert run(["validate", "r2", "--quick"]) == 1
    text = " ".join(capsys.readouterr().out.split())
    assert "checks failed" in text
    assert "loop_gap (r2 p1p2)" in text


def test_a_run_that_breaks_down_is_a_verdict(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    import mujoco

    from fes_mj.simulation import mjcf

    monkeypatch.setitem(mjcf.INTEGRATORS, "discrete", mujoco.mjtIntegrator.mjINT_IMPLICITFAST)
    code, content = _json(capsys, "validate", "d1", "--quick")
    failed = [each["name"] for each in content["checks"] if not each["ok"]]
    assert code == 1
    assert "stability" in failed
    assert content["runs"] == []


def test_an_own_design_is_validated_without_the_paper(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    from fes_mj import load_design
    from fes_mj.design_file import design_toml

    path = tmp_path / "own.toml"
    path.write_text(design_toml(load_design("r2")))
    code, content = _json(capsys, "validate", str(path), "--quick")
    names = {each["name"] for each in content["checks"]}
    assert code == 0
    assert "mean_power" in names
    assert not {"joint_range", "printed_power"} & names


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("r9",), "no such design"),
        (("r2", "--dims", "printed"), "rocker and coupler cannot close"),
        (("d1", "--report", "out.txt"), "must end in .html"),
        (("d1", "--junit", "nowhere/out.xml"), "does not exist"),
        (("d1", "--video", "a.mp4"), "--report"),
        (("d1", "--report", "out.html", "--video", "none.mp4"), "cannot read the video"),
        (("d1", "--group", "p1p2", "--moments", "x.csv"), "exclude each other"),
    ],
)
def test_bad_input(
    arguments: tuple[str, ...],
    words: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["validate", "--quick", *arguments]) == 2
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.out == ""
    assert list(tmp_path.iterdir()) == []


def test_a_missing_package_names_the_extra(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "jinja2", None)
    assert run(["validate", "d1", "--quick", "--report", str(tmp_path / "out.html")]) == 3
    assert "pip install 'fes-mj[report]'" in capsys.readouterr().err


class _Page(HTMLParser):
    """Text, tags and addresses of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.addresses: list[str] = []
        self.count: dict[str, int] = {}

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.count[tag] = self.count.get(tag, 0) + 1
        # xlink:href="#..." points into the same figure
        self.addresses += [value or "" for name, value in attributes if name in ("src", "href", "xlink:href")]


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Report and JUnit file of a full run of one design with faults and a video."""
    folder = tmp_path_factory.mktemp("report")
    (folder / "run.mp4").write_bytes(b"not a real video")
    files = {"html": folder / "out.html", "xml": folder / "out.xml"}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fes_mj.verification.mistakes.faults", lambda: faults()[:3])  # all of them: test_faults.py
        outputs = ["--report", str(files["html"]), "--junit", str(files["xml"])]
        code = run(["validate", "d1", "-q", "--faults", *outputs, "--video", str(folder / "run.mp4")])
    assert code == 0
    return {name: path.read_text() for name, path in files.items()}


def test_the_report_needs_no_network(report: dict[str, str]) -> None:
    page = _Page()
    page.feed(report["html"])
    assert all(address.startswith(("#", "data:")) for address in page.addresses)
    assert not {"script", "link", "iframe", "img"} & set(page.count)
    assert not re.search(r"@import|url\((?!#)", report["html"])


def test_the_report_opens_with_the_verdict_and_shows_everything(report: dict[str, str]) -> None:
    page = _Page()
    page.feed(report["html"])
    text = re.sub(r"<[^>]*>", " ", report["html"].split("<body>")[1])
    order = [
        text.index(word) for word in ("checks hold", "Runs", "d1 p1p2", "Crank power over", "Provenance", "python")
    ]
    assert order == sorted(order)
    assert page.count["svg"] == 2 + 2 + 1  # power and refinement of two groups, the chain
    assert page.count["video"] == 1
    assert "data:video/mp4;base64,bm90IGEgcmVhbCB2aWRlbw==" in report["html"]
    assert all(name in text for name in definitions())
    assert "knee moment on the shank" in text
    assert 'name="viewport"' in report["html"]


def test_junit_counts_every_verdict(report: dict[str, str]) -> None:
    suites = ElementTree.fromstring(report["xml"]).findall("testsuite")
    assert {suite.get("name") for suite in suites} >= {"d1 p1p2", "d1 p1p3", "A02", "injected faults"}
    for suite in suites:
        assert int(suite.get("tests", -1)) == len(suite.findall("testcase"))
        assert suite.get("failures") == "0"


def test_junit_reports_failures() -> None:
    from fes_mj.verification.junit import junit_xml

    root = ElementTree.fromstring(
        junit_xml([check("loop_gap", 1.0, "d1 <p1p2>"), check("mean_power", 0.0, "d1 <p1p2>")])
    )
    suite = root.find("testsuite")
    assert suite is not None
    assert suite.get("failures") == "1"
    failure = suite.find("testcase/failure")
    assert failure is not None
    assert "1 m (limit 1e-05 m)" in failure.get("message", "")
