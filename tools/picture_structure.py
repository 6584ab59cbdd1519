"""Draw the rooms of the package as floors, from the import contract: python -m tools.picture_structure"""

import ast
import tomllib
from html import escape
from pathlib import Path

from fes_mj.common.style import INK
from fes_mj.common.writing import replacing

ROOT = Path(__file__).parents[1]
PICTURE = ROOT / "docs" / "images" / "structure.svg"
WIDTH, FLOOR, BOX, GAP = 860, 62, 42, 12  # px
# What a floor hands up to those above it.
HANDED_UP = {
    "linkage": "Design, Motion, masses",
    "moments": "JointMoments, TorqueMap",
    "muscles": "Riders, MuscleTurn",
    "statics": "QuasiStatic, Cycles",
    "riding": "Ride, Fit, error budget",
    "simulation": "MjSpec, Simulation",
    "crosscheck": "Case, RideCase, sweeps",
    "viewing": "video, figures, pages",
    "verification": "verdicts, found designs",
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
    rows = floors()
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {FLOOR * len(rows) + GAP}" '
        f'font-family="sans-serif" font-size="12" fill="{INK}">'
        f"<style>rect {{ fill: none; stroke: {INK} }}</style>"
    ]
    for number, rooms in enumerate(rows):
        top, width = GAP + FLOOR * number, (WIDTH - GAP) / len(rooms) - GAP
        for column, room in enumerate(rooms):
            left = GAP + column * (width + GAP)
            most = int(width / 6.8)
            words = purpose(room)
            words = words if len(words) <= most else words[: most - 1].rsplit(" ", 1)[0].rstrip(",") + " …"
            lines += [
                f'<rect x="{left:.0f}" y="{top}" width="{width:.0f}" height="{BOX}" rx="4"/>',
                f'<text x="{left + 10:.0f}" y="{top + 17}" font-weight="bold">{room}</text>',
                f'<text x="{left + 10:.0f}" y="{top + 34}">{escape(words)}</text>',
            ]
        for room in rooms:
            if room in HANDED_UP:
                lines.append(
                    f'<text x="{WIDTH / 2:.0f}" y="{top - 6}" font-size="11" text-anchor="middle">'
                    f"\N{UPWARDS ARROW} {HANDED_UP[room]}</text>"
                )
    return "\n".join([*lines, "</svg>", ""])


def main() -> None:
    """Draw it and keep it."""
    with replacing(PICTURE) as beside:
        beside.write_text(drawing(), encoding="utf-8")


if __name__ == "__main__":
    main()
