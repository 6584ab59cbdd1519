"""One look for video, figures, pages and reports: colours, and which way riders face.

Matplotlib users apply STYLE with matplotlib.rc_context; matplotlib itself is not imported here.
"""

from typing import Any

# What is plotted
COLOURS = {
    "knee": "#00a2bf",
    "hip": "#c4189a",
    "mujoco": "#1f4fd8",
    "reference": "#8a8f98",  # the exact inverse dynamics
    "quasi-static": "#d97a00",
    "comparison": "#3a7d44",  # another design beside this one
}
# Bodies; the video's materials and the figures' lines
LINKS = {"thigh": "#cdb399", "shank": "#e0c9b0", "crank": "#e07d28", "rocker": "#736bad", "coupler": "#5c945c"}
# Curves of the same kind beside each other, in their order
SERIES = ("#1f4fd8", "#d97a00", "#3a7d44")
# Whose moments a power is due to: the groups, then others; colours that stand for nothing else
MOMENTS = ("#6b2fb3", "#7a4a1e", "#00695c")
# The paper's designs side by side: the traditional one, crank-rockers green, coupler-driven ones red
BY_DESIGN = {"trt": "#20242c", "r1": "#7fb069", "r2": "#2f6b3c", "d1": "#c01c28", "d2": "#e8899b"}
# Parts of a whole, stacked, the last for what is left
PART_COLOURS = ("#1f4fd8", "#8a8f98", "#c01c28", "#d97a00", "#3a7d44", "#c4189a", "#d9dce1")
GOOD, BAD = "#1a7f37", "#c01c28"
INK, FAINT = "#20242c", "#5a606c"

# The paper's x runs backwards. Pictures show it to the left, so that riders face right, as in the video.
X_LABEL = "x, m (backwards; the rider faces right)"
CRANK_LABEL = "crank angle, deg (0: crank backwards)"

STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.5,
    "svg.hashsalt": "fes_mj",  # the same file from the same numbers
    "svg.fonttype": "none",  # text stays text
}


def literal(text: str) -> str:
    """The text as matplotlib draws it literally, whatever dollar signs it holds."""
    return text.replace("$", r"\$")


def rgb(colour: str) -> tuple[float, float, float]:
    """Red, green and blue of "#rrggbb", each 0 to 1."""
    red, green, blue = (round(int(colour[i : i + 2], 16) / 255, 3) for i in (1, 3, 5))
    return red, green, blue


def hex_colour(colour: tuple[float, float, float]) -> str:
    """The colour as "#rrggbb": the inverse of rgb."""
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour)
