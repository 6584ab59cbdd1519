"""Write fes_mj/data/muscles: polynomials of muscle lengths with their parameters, and the potential of passive moments.

python -m tools.make_muscles LENGTHS.csv PARAMETERS.json [OUT.toml]: lengths over hip and knee flexion (m, deg; a column
a muscle) and parameters as they were read off an OpenSim model. Prints the largest errors of the fits.
"""

import json
import sys
from pathlib import Path

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.writing import write_text
from fes_mj.moments.tables import load_table
from fes_mj.muscles.anatomy import ANATOMY_FILE
from fes_mj.muscles.geometry import Flexion, derivatives, terms
from fes_mj.muscles.passive import PASSIVE_FILE as PASSIVE, published

DEGREE = 5
DECIMALS = 9  # of m and J
# Group and the segments along which a muscle lies, by what its name begins with.
MUSCLES = {
    "vas": ("quadriceps", ["thigh"]),
    "rec": ("quadriceps", ["thigh", "shank"]),
    "sem": ("hamstrings", ["thigh", "shank"]),
    "bifemlh": ("hamstrings", ["thigh", "shank"]),
    "bflh": ("hamstrings", ["thigh", "shank"]),
    "bifemsh": ("hamstrings", ["thigh"]),
    "bfsh": ("hamstrings", ["thigh"]),
    "gl": ("gluteus", ["thigh"]),
}
GAIT2392 = """\
# Muscle lengths over hip and knee flexion (ankle at a right angle) and parameters of the model Gait 2392 of OpenSim:
# Delp et al., IEEE Trans. Biomed. Eng. 37 (1990) 757-767, with later changes by Thelen, Seth, Anderson and Delp;
# Creative Commons Attribution 3.0 (https://creativecommons.org/licenses/by/3.0/). Changed here: lengths read off the
# model every 5 deg are given as polynomials, of which fit_error_mm is the largest error.
# Written by tools/make_muscles.py.
# coefficients_m: per rad of hip and knee flexion from 70 and 67.5 deg, 1, h, k, h^2, h k, k^2, h^3, ...
"""
POTENTIAL = """\
# Potential of the passive moments of hip and knee, J, fitted to the curves of Riener and Edrich, J. Biomech. 32
# (1999) 539-544, which are no derivatives of one function. Order of the terms as in gait2392.toml.
# Written by tools/make_muscles.py.
# largest_distance_Nm: from the published curves within the range, of knee and hip.
"""
ADULTS = {"gait2392": (0.410, 0.430), "rajagopal": (0.414, 0.397)}  # m, thigh and shank, at 70 and 75 deg of flexion
HIP, KNEE = (30, 120), (10, 125)  # deg, for which the passive curves are fitted


def polynomials(flexion: Flexion, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coefficients, shape (columns, terms), and largest error of each column of values over the angles."""
    features = terms(flexion, DEGREE).T
    fitted = np.linalg.lstsq(features, values)[0].round(DECIMALS)
    return fitted.T, np.abs(features @ fitted - values).max(axis=0)


def potential() -> tuple[FloatArray, list[float]]:
    """Coefficients of the potential, and its derivatives' largest distance from the published curves, N m."""
    hip, knee = (
        grid.ravel() for grid in np.meshgrid(np.arange(HIP[0], HIP[1] + 1.0), np.arange(KNEE[0], KNEE[1] + 1.0))
    )
    features = terms(Flexion(np.radians(hip), np.radians(knee)), DEGREE)
    moments = published(hip, knee)
    by_knee, by_hip = (-part @ features for part in derivatives(np.eye(len(features)), DEGREE))
    stacked, target = np.concatenate([by_knee, by_hip], axis=1)[1:], np.concatenate([*moments])
    fitted = np.linalg.lstsq(stacked.T, target)[0].round(DECIMALS)
    distance = np.abs(fitted @ stacked - target)
    return np.concatenate([[0.0], fitted]), [float(part.max()) for part in np.split(distance, 2)]


def numbers(values: FloatArray) -> str:
    """A line of a TOML file; 0 without its sign."""
    return f"[{', '.join(f'{value + 0.0:.{DECIMALS}g}' for value in values)}]"


def main() -> None:
    lengths, parameters, path = (
        Path(sys.argv[1]),
        Path(sys.argv[2]),
        Path(sys.argv[3]) if sys.argv[3:] else ANATOMY_FILE,
    )
    table, parameters_of = load_table(lengths, "muscle lengths"), json.loads(parameters.read_text())
    angles = [table.column(f"{joint}_flexion_deg") for joint in ("hip", "knee")]
    columns = np.column_stack([table.column(f"{name}_m") for name in parameters_of])
    fitted, errors = polynomials(Flexion(*np.radians(angles)), columns)
    thigh, shank = next(adult for model, adult in ADULTS.items() if lengths.name.startswith(model))
    ranges = [f"[{angle.min():g}, {angle.max():g}]" for angle in angles]
    lines = [GAIT2392, "[adult]", f"degree = {DEGREE}", f"thigh_m = {thigh}", f"shank_m = {shank}"]
    lines += [f"hip_flexion_deg = {ranges[0]}", f"knee_flexion_deg = {ranges[1]}"]
    for (name, row), coefficients, error in zip(parameters_of.items(), fitted, errors, strict=True):
        group, segments = next(kind for start, kind in MUSCLES.items() if name.startswith(start))
        lines += ["", f"[muscle.{name.removesuffix('_r')}]", f'group = "{group}"', f"segments = {json.dumps(segments)}"]
        lines += [f"{key} = {value!r}" for key, value in row.items() if key != "max_speed_fibre_lengths_per_s"]
        lines += [f"fit_error_mm = {1e3 * error:.3f}", f"coefficients_m = {numbers(coefficients)}"]
        print(f"{name}: {1e3 * error:.3f} mm")
    write_text(path, "\n".join([*lines, ""]))
    coefficients, distance = potential()
    print(f"passive moments: {distance[0]:.2f} N m at the knee, {distance[1]:.2f} at the hip")
    lines = [POTENTIAL, f"degree = {DEGREE}", f"largest_distance_Nm = [{distance[0]:.2f}, {distance[1]:.2f}]"]
    write_text(PASSIVE, "\n".join([*lines, f"coefficients_J = {numbers(coefficients)}", ""]))


if __name__ == "__main__":
    main()
