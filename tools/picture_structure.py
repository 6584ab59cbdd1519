"""Draw the rooms of the package as floors, from the import contract: python -m tools.picture_structure"""

import ast
import textwrap
import tomllib
from html import escape
from pathlib import Path

from fes_mj.common.style import INK
from fes_mj.common.writing import replacing

ROOT = Path(__file__).parents[1]
PICTURE = ROOT / "docs" / "images" / "structure.svg"
WIDTH, GAP, INSET, LINE = 860, 8, 10, 15  # px
CHARACTER = 7.2  # px, on average, of the widest of the usual fonts
# What a room is asked for by others: names that it defines.
HANDED_UP = {
    "cli": ("main",),
    "paper": ("reproduce", "table1"),
    "explore": ("serve", "Answers"),
    "verification": ("verify", "inject"),
    "validation": ("rows", "Experiment"),
    "optimization": ("Findings", "Winner"),
    "viewing": ("render_video", "write_figure", "page"),
    "drawing": ("folder",),
    "sweep": ("Sweep", "load_study"),
    "crosscheck": ("Case", "RideCase"),
    "simulation": ("build_mjcf", "mjcf_text", "Simulation"),
    "budget": ("answer", "error_budget"),
    "riding": ("Ride", "Trace", "Starts"),
    "fit": ("fit_seat", "fit_population"),
    "statics": ("QuasiStatic", "MuscleStatic", "Cycles", "WorkTable"),
    "muscles": ("Muscles", "Riders", "Windows"),
    "moments": ("JointMoments", "TorqueMap"),
    "linkage": ("Design", "Motion", "turning"),
    "common": ("FloatArray", "InputError", "read_toml", "Check"),
}


def floors() -> list[list[str]]:
    """Rooms of each floor, the top floor first."""
    contract = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"][0]
    return [layer.split(" | ") for layer in contract["layers"]]


def purpose(room: str) -> str:
    """A room's own words for itself, up to the first colon."""
    documented = ast.get_docstring(ast.parse((ROOT / "fes_mj" / room / "__init__.py").read_text())) or ""
    return documented.split(":")[0].split(".")[0]


def drawing() -> str:
    """The picture as SVG."""
    top, lines = GAP, []
    for rooms in floors():
        width = (WIDTH - GAP) / len(rooms) - GAP
        captions = [textwrap.wrap(purpose(room), int((width - 2 * INSET) / CHARACTER)) for room in rooms]
        height = LINE * (1 + max(map(len, captions))) + INSET
        for column, (room, caption) in enumerate(zip(rooms, captions, strict=True)):
            left = GAP + column * (width + GAP)
            lines += [
                f'<rect x="{left:.0f}" y="{top}" width="{width:.0f}" height="{height}" rx="4"/>',
                f'<text x="{left + INSET:.0f}" y="{top + LINE}" font-weight="bold">{room}</text>',
                f'<text x="{left + width - INSET:.0f}" y="{top + LINE}" font-size="11" text-anchor="end">'
                f"\N{UPWARDS ARROW} {', '.join(HANDED_UP[room])}</text>",
            ] + [
                f'<text x="{left + INSET:.0f}" y="{top + LINE * (2 + row)}">{escape(words)}</text>'
                for row, words in enumerate(caption)
            ]
        top += height + GAP
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {top}" '
        f'font-family="sans-serif" font-size="12" fill="{INK}">'
        f"<style>rect {{ fill: none; stroke: {INK} }}</style>"
    )
    return "\n".join([head, *lines, "</svg>", ""])


def main() -> None:
    """Draw it and keep it."""
    with replacing(PICTURE) as beside:
        beside.write_text(drawing(), encoding="utf-8")


if __name__ == "__main__":
    main()
