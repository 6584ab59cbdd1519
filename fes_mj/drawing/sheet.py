"""One sheet of a design: its mechanism in both extreme positions, every link with dimensions, tables, title block."""

import io
from collections.abc import Sequence
from importlib.metadata import version

import numpy as np

from fes_mj.common.text import printable
from fes_mj.common.units import RPM
from fes_mj.drawing.mechanism import FIXED_POINTS, LINE, SCALES, Box, largest_scale, mechanism, ratio
from fes_mj.drawing.part import FIRST, draw_part, notes, plate_extent
from fes_mj.drawing.pen import TEXT_HEIGHT, Pen
from fes_mj.linkage.clearance import CLEARANCE, Gap
from fes_mj.linkage.plates import Plate
from fes_mj.statics.materials import pin_stock
from fes_mj.statics.sizes import Build

WIDTH, HEIGHT, BORDER, BINDING = 594.0, 420.0, 10.0, 20.0  # mm: A2, ISO 5457
DIMENSION_ROOM = FIRST + 6.0  # mm around a link for its dimensions
_LINKS, _UNDER, _GAP = 344.0, 110.0, 5.0  # mm: where links begin from the left, how high tables reach, between boxes
_TITLE, _NAMES, _ROW = 180.0, 24.0, 7.0  # mm: width of the title block (ISO 7200), of its names, height of a row
_LISTED = 6  # clearances


def sheet(build: Build) -> Pen:
    """The drawing, in full size of the paper."""
    pen, right, top = Pen.new(), WIDTH - BORDER, HEIGHT - BORDER
    corners = (complex(x, y) for x, y in ((BINDING, BORDER), (right, BORDER), (right, top), (BINDING, top)))
    pen.line(list(corners), "FRAME", close=True)
    side, left = build.stack.side, BINDING + _GAP
    apart = sorted((gap for gap in side.gaps if gap.distance > 0), key=lambda gap: gap.distance)
    gaps = list(dict.fromkeys([*side.hindrances, *apart]))[:_LISTED]
    mechanism(pen, build, gaps, Box(left, BORDER + _UNDER, _LINKS - _GAP, top - _GAP))
    _links(pen, build, Box(_LINKS, BORDER + 7 * _ROW, right - _GAP, top - _GAP))
    _lines(pen, _tables(build, gaps), complex(left, BORDER + _UNDER))
    _title(pen, build)
    return pen


def _links(pen: Pen, build: Build, box: Box) -> None:
    """Every link below the one before, with its notes."""
    plates, top = [*build.plates.values()], box.top
    scales = _scales(plates, box.size)
    spare = (box.size.imag - sum(map(_height, plates, scales))) / len(plates)
    for plate, scale in zip(plates, scales, strict=True):
        low, high = plate_extent(plate)
        below = _lines(pen, notes(build, plate, ratio(scale)), complex(box.left, top))
        corner = complex(box.left + DIMENSION_ROOM, below - DIMENSION_ROOM - scale * (high - low).imag)
        draw_part(pen.moved(corner - scale * low, scale), plate)
        top -= _height(plate, scale) + spare


def _height(plate: Plate, scale: float) -> float:
    """Of a link with its notes and dimensions, mm."""
    low, high = plate_extent(plate)
    return scale * float((high - low).imag) + 2 * DIMENSION_ROOM + LINE * (1 + len(plate.holes))


def _scales(plates: Sequence[Plate], room: complex) -> list[float]:
    """The largest in which all links fit below each other: the tallest is made smaller as long as they do not."""
    wide = (plate_extent(plate)[1] - plate_extent(plate)[0] for plate in plates)
    scales = [largest_scale(size.real + 0j, room - 2 * DIMENSION_ROOM) for size in wide]
    while sum(map(_height, plates, scales)) > room.imag:
        heights = [*map(_height, plates, scales)]
        tallest = heights.index(max(heights))
        scales[tallest] = SCALES[SCALES.index(scales[tallest]) + 1]
    return scales


def _lines(pen: Pen, lines: Sequence[str], at: complex) -> float:
    """Lines of text below each other; how far down they reach, mm."""
    for number, line in enumerate(lines, 1):
        if line:
            pen.text(line, at - 1j * LINE * number)
    return at.imag - LINE * len(lines)


def _tables(build: Build, gaps: Sequence[Gap]) -> list[str]:
    """Clearances, how the layers lie, where the pivots are."""
    stack, points = build.stack, build.stack.side.motion.points
    layers = sorted(stack.layers, key=lambda body: stack.layers[body])
    pivots = {name: 1e3 * complex(points[name].value) for name in FIXED_POINTS if name in points and name != "hip"}
    return [
        f"CLEARANCES, seen from the side, over the whole turn of both legs, mm (wanted: {1e3 * CLEARANCE:g})",
        *(
            f"{number}  {gap.pair}: {1e3 * gap.distance:.1f} at crank angle {np.degrees(gap.crank_angle):.0f} deg"
            for number, gap in enumerate(gaps, 1)
        ),
        f"beside each other: {', '.join(gap.pair for gap in stack.side.gaps if gap.distance <= 0) or 'nothing'}",
        "",
        "LAYERS, from the tricycle's middle to the middle of each plate, mm",
        *(f"{stack.layers[body]}  {body}: {1e3 * stack.level(body):.1f}" for body in layers),
        f"leg: {1e3 * stack.level('shank'):.1f}, between the middles of the feet {1e3 * stack.feet:.0f}",
        "",
        "ON THE FRAME, from the hip, mm forwards and up",
        *(f"{name.replace('_', ' ')}: {-place.real:.1f}, {place.imag:.1f}" for name, place in pivots.items()),
    ]


def _title(pen: Pen, build: Build) -> None:
    """The title block, bottom right; without a date."""
    turn, rider = build.turn, build.design.rider
    rows = {
        "design": printable(build.design.name),
        "kind": build.design.linkage.title,
        "power": f"{turn.power_mean:.2f} W in the mean, one leg ({turn.moments.name}), {turn.cadence / RPM:.1f} rpm",
        "rider": f"thigh {1e3 * rider.thigh:g} mm, shank {1e3 * rider.shank:g} mm, {rider.mass:g} kg",
        "material": f"{build.material.name}, links {sum(build.mass.values()):.2f} kg a side; pins {pin_stock().name}",
        "scales": "as stated; dimensions in mm; tolerances without indication ISO 2768-m",
        "made by": f"fes_mj {version('fes-mj')}; A2",
    }
    left, right, top = WIDTH - BORDER - _TITLE, WIDTH - BORDER, BORDER + _ROW * len(rows)
    pen.line([complex(left, BORDER), complex(left, top), complex(right, top), complex(right, BORDER)], "FRAME")
    pen.line([complex(left + _NAMES, BORDER), complex(left + _NAMES, top)], "TEXT")
    for number, (name, text) in enumerate(rows.items(), 1):
        below = top - number * _ROW
        pen.line([complex(left, below), complex(right, below)], "TEXT")
        pen.text(name, complex(left + 2, below + 2))
        pen.text(text, complex(left + _NAMES + 2, below + 2), height=TEXT_HEIGHT if number > 1 else 1.6 * TEXT_HEIGHT)


def pictures(pen: Pen) -> list[bytes]:
    """The sheet as SVG and as PDF; without a date, so that the same sheet gives the same bytes."""
    import matplotlib as mpl
    from ezdxf.addons.drawing.config import BackgroundPolicy, ColorPolicy, Configuration
    from ezdxf.addons.drawing.frontend import Frontend
    from ezdxf.addons.drawing.matplotlib import MatplotlibBackend
    from ezdxf.addons.drawing.properties import RenderContext
    from matplotlib.figure import Figure

    look = Configuration(
        background_policy=BackgroundPolicy.WHITE,
        color_policy=ColorPolicy.BLACK,
        lineweight_scaling=72 / 25.4,  # the backend takes mm for points
        min_lineweight=0.1,
    )
    files = []
    with mpl.rc_context({"svg.hashsalt": "fes_mj"}):
        figure = Figure(figsize=(WIDTH / 25.4, HEIGHT / 25.4))
        axes = figure.add_axes((0, 0, 1, 1))
        backend = MatplotlibBackend(axes, adjust_figure=False)
        Frontend(RenderContext(pen.document), backend, look).draw_layout(pen.document.modelspace())
        axes.set(xlim=(0, WIDTH), ylim=(0, HEIGHT))
        for suffix, dated in (("svg", "Date"), ("pdf", "CreationDate")):
            stream = io.BytesIO()
            figure.savefig(stream, format=suffix, metadata={dated: None})
            files.append(stream.getvalue())
    return files
