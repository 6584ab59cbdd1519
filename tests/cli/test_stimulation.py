"""`fes_mj stimulation`: table, JSON, CSV and page, and what it refuses."""

import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from fes_mj.linkage.design_file import load_design
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.settings import Settings
from fes_mj.viewing.settings_page import settings_figure
from tests.cli.conftest import answer, result

MOMENTS = ("--drive", "moments")


@pytest.fixture(scope="module")
def few(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """A few riders: all that a command line asks of them."""
    path = tmp_path_factory.mktemp("riders") / "few.npz"
    load_riders("p1p2").taken(slice(0, 5)).save(path)
    return "--muscles", str(path)


def test_table_json_and_files(capsys: pytest.CaptureFixture[str], tmp_path: Path, few: tuple[str, str]) -> None:
    table, pages = tmp_path / "d1.csv", [tmp_path / f"d1.{suffix}" for suffix in ("svg", "pdf")]
    arguments = ["stimulation", "d1", *few, "--cadence", "60", "--cadence", "30", "--duty", "0.2"]
    drawn = [part for page in pages for part in ("-o", str(page))]
    code, out, _ = result(capsys, *arguments, "--csv", str(table), *drawn)
    assert code == 0
    for said in ("d1 at 60.0 rpm, right leg; few muscles", "W per effort", "points backwards", "180 deg", "By cadence"):
        assert said in out
    assert table.read_text().startswith("cadence_rpm,muscle,leg,on_deg,off_deg,")
    assert [page.read_bytes()[:4] for page in pages] == [b"<?xm", b"%PDF"]
    assert "few, 5 riders who may be this one" in pages[0].read_text()
    _within_the_page(settings_figure(Settings.solve(load_design("d1"), load_riders(few[1]), [6.28], 6.28)))
    code, content = answer(capsys, *arguments)
    assert code == 0
    assert (content["duty_limit"], round(content["cadence_rpm"])) == (0.2, 60)
    assert [round(setting["cadence_rpm"]) for setting in content["settings"]] == [30, 60]
    first = next(row for row in content["windows"] if round(row["cadence_rpm"]) == 60)
    assert (first["muscle"], first["leg"]) == ("quadriceps", "right")
    assert f"{first['on_deg']:.0f} to {first['off_deg']:.0f}" in out


@pytest.mark.parametrize("drive", ["muscles", "moments"])
def test_legs_are_whose_windows_are_given(
    drive: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, few: tuple[str, str]
) -> None:
    page, table = tmp_path / "page.svg", tmp_path / "windows.csv"
    own = ["stimulation", "d1", "--drive", drive, *(few if drive == "muscles" else ())]
    both, one = (answer(capsys, *own, "--legs", legs)[1] for legs in "21")
    assert answer(capsys, *own)[1] == both
    assert one["windows"] == [row for row in both["windows"] if row["leg"] == "right"] != both["windows"]
    code, out, _ = result(capsys, *own, "--legs", "1", "--csv", str(table), "-o", str(page))
    assert (code, "left" in out + table.read_text(), "both legs" in out) == (0, False, False)
    assert "left" not in page.read_text().lower().replace("text-align: left", "")
    if drive == "muscles":
        assert one["power_one_leg_W"] == pytest.approx(one["power_mean_W"])
        assert both["power_two_legs_W"] == pytest.approx(2 * one["power_one_leg_W"])
        assert both["power_two_legs_30_min_W"] == pytest.approx([2 * power for power in one["power_one_leg_30_min_W"]])
        assert both["power_two_legs_min_W"] > 2 * one["power_one_leg_min_W"]


def _within_the_page(figure: Figure) -> None:
    """Each of the page's own lines of text ends on it."""
    page = figure.bbox
    for text in figure.texts:
        box = text.get_window_extent(FigureCanvasAgg(figure).get_renderer())
        assert page.x0 <= box.x0 < box.x1 <= page.x1, text.get_text()


def test_with_one_cadence_or_none_those_that_a_start_passes(
    capsys: pytest.CaptureFixture[str], few: tuple[str, str]
) -> None:
    _, content = answer(capsys, "stimulation", "trt", *few)
    assert [round(setting["cadence_rpm"]) for setting in content["settings"]] == [30, 40, 50, 60]
    assert content["cadence_rpm"] == pytest.approx(60.13, abs=0.01)
    assert content["seat"]["seat_angle_deg"] == pytest.approx(60)
    _, content = answer(capsys, "stimulation", "trt", *few, "--cadence", "45")
    assert [round(setting["cadence_rpm"]) for setting in content["settings"]] == [30, 45]


def test_moments_say_where_the_linkage_lets_them_drive(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    table, picture = tmp_path / "d1.csv", tmp_path / "d1.svg"
    code, out, _ = result(capsys, "stimulation", "d1", *MOMENTS, "--csv", str(table), "-o", str(picture))
    assert code == 0
    assert "quadriceps (knee extension)" in out
    assert table.read_text().startswith("muscle,moment,leg,works_on_deg,works_off_deg,")
    assert picture.read_text().startswith("<?xml")
    first = answer(capsys, "stimulation", "d1", *MOMENTS)[1]["windows"][0]
    assert first["works_deg"] == pytest.approx([315, 84], abs=0.6)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["d9"], "d9"),
        (["d1", "--cadence", "0"], "for --cadence. It must be a cadence in rpm from 1 to 200"),
        (["d1", "--cadence", "60", "--cadence", "nan"], "for --cadence. It must be a cadence"),
        (["d1", "--lag", "0.1"], "--drive muscles"),
        (["d1", *MOMENTS, "--lag", "0.1"], "--drive muscles"),
        (["d1", "--duty", "0"], '"0.0" for --duty. It must be a share of the turn'),
        (["d1", "--duty", "1.1"], '"1.1" for --duty'),
        (["d1", "--timing", "by-angle"], "static d1 --drive muscles --timing by-angle"),
        (["d1", "--moments", "mine.toml"], "fes_mj moments mine.toml --fit-muscles -o RIDER.npz"),
        (["d1", "--muscles", "nowhere.npz"], "nowhere.npz"),
        (["d1", *MOMENTS, "--cadence", "60"], "--cadence 60.0 and --drive moments exclude each other"),
        (["d1", "--csv", "{folder}/x.txt"], "must end in .csv"),
        (["d1", "--csv", "{folder}/none/x.csv"], "does not exist"),
        (["d1", "-o", "{folder}/x.txt"], "must end in .svg or .pdf or .png"),
        (["r2", "--dims", "printed"], "cannot close at crank angle"),
    ],
)
def test_bad_input_is_one_message_and_no_file(
    arguments: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = result(capsys, "stimulation", *(part.format(folder=tmp_path) for part in arguments))
    assert (code, out) == (2, "")
    assert said in err
    assert "Traceback" not in err
    assert not [*tmp_path.iterdir()]


def test_no_output_replaces_the_design(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (link := tmp_path / "a.csv").write_text('[linkage]\nkind = "trt"\n')
    code, _, err = result(capsys, "stimulation", str(link), "--csv", str(link))
    assert code == 2
    assert link.read_text().startswith("[linkage]")
    assert "a.csv" in err


def test_it_needs_no_mujoco(few: tuple[str, str]) -> None:
    script = "import sys; from fes_mj.cli.app import run; run(sys.argv[1:]); sys.exit('mujoco' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script, "stimulation", "d1", "-q", *few]).returncode == 0
