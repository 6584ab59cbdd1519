"""Files of motion capture (.c3d) as tables: time, and the three components of every point and model output."""

import warnings
from pathlib import Path

import numpy as np

from fes_mj.common.errors import InputError, require_extra


def c3d_columns(path: Path) -> dict[str, list[str]]:
    """Columns as text by name: "time" (s), and LABEL.x, LABEL.y, LABEL.z; nan where a point was not seen.

    Raises InputError for a file that cannot be read, MissingPartError without the package c3d.
    """
    c3d = require_extra("c3d", "c3d")
    try:
        with path.open("rb") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of files without analog channels
            reader = c3d.Reader(file)
            labels = [label.strip() for label in reader.point_labels]
            frames = [(number, points) for number, points, _ in reader.read_frames()]
            rate = float(reader.point_rate)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except Exception as error:  # the package tells damaged files by whatever its parser runs into
        raise InputError(f"{path}: no .c3d file that can be read: {error}") from None
    values = np.array([points[:, :3] for _, points in frames], float).reshape(len(frames), len(labels), 3)
    values[np.array([points[:, 3] for _, points in frames]).reshape(values.shape[:2]) < 0] = np.nan
    columns = {"time": [repr(number / rate) for number, _ in frames]}
    for place, label in enumerate(labels):
        columns |= {f"{label}.{axis}": [*map(repr, values[:, place, i].tolist())] for i, axis in enumerate("xyz")}
    return columns
