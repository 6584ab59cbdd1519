"""Sweeps: a study evaluated in chunks, each a Parquet file that appears whole; what is there is not done again."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fes_mj.arrays import BoolArray
from fes_mj.cycles import WorkTable, cycles
from fes_mj.design import Design
from fes_mj.design_file import design_toml
from fes_mj.errors import InputError, UnstableError, require_extra
from fes_mj.files import read_json, replacing, write_text
from fes_mj.joints import JOINTS
from fes_mj.moments import JointMoments
from fes_mj.parallel import HERE, Workers, run_tasks
from fes_mj.sweep.study import Study
from fes_mj.units import RPM
from fes_mj.variables import COMPONENTS, replaced

MANIFEST = "study.json"
Columns: TypeAlias = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Sweep:
    """A study and the folder of its results."""

    study: Study
    folder: Path

    def path(self, chunk: int) -> Path:
        """File of a chunk."""
        return self.folder / f"chunk-{chunk:07d}.parquet"

    def finished(self) -> list[int]:
        """Chunks whose file is there; files are only ever there whole."""
        return [chunk for chunk in range(self.study.chunks) if self.path(chunk).exists()]

    def claim(self) -> None:
        """Make the folder this study's, or check that it is. Raises InputError if it holds other results."""
        self.folder.mkdir(exist_ok=True)
        manifest, ours = self.folder / MANIFEST, _manifest(self.study)
        if not manifest.exists():
            if any(self.folder.iterdir()):
                raise InputError(f"{self.folder}: this folder is not empty and holds no study; name a new one")
            write_text(manifest, json.dumps(ours, indent=1))
            return
        theirs = read_json(manifest, "record of the study")
        different = [key for key in ours if ours[key] != theirs.get(key)]
        if different:
            raise InputError(
                f"{self.folder}: this folder holds the results of another study (different: {', '.join(different)}); "
                "name another folder"
            )

    def run(self, workers: Workers = HERE, progress: Callable[[int], None] | None = None) -> None:
        """Evaluate the chunks that are not there yet; progress is told the points of each chunk as it is written."""
        parquet = require_extra("optimize", "pyarrow.parquet")
        arrow = require_extra("optimize", "pyarrow")
        self.claim()
        finished = {*self.finished()}
        missing = [chunk for chunk in range(self.study.chunks) if chunk not in finished]
        for index, columns in run_tasks(partial(evaluate, self.study), missing, workers):
            with replacing(self.path(missing[index])) as temporary:
                # NaN, for what could not be computed, becomes null
                arrays = {name: arrow.array(column, from_pandas=True) for name, column in columns.items()}
                parquet.write_table(arrow.table(arrays), temporary)
            if progress:
                progress(len(columns["point"]))

    def read(self) -> Any:
        """All finished results as one pyarrow table, by point."""
        dataset = require_extra("optimize", "pyarrow.dataset")
        files = [str(self.path(chunk)) for chunk in self.finished()]
        return dataset.dataset(files, format="parquet").to_table().sort_by("point")

    def summary(self) -> dict[str, Any]:
        """Numbers of points, and the one with the most mean crank power."""
        compute, table = require_extra("optimize", "pyarrow.compute"), self.read()
        turning, best = int(compute.sum(table["turns"]).as_py() or 0), None
        if turning:
            power = table["power_mean_W"]
            best = table.slice(compute.index(power, compute.max(power)).as_py(), 1).to_pylist()[0]
        return {"folder": str(self.folder), "points": table.num_rows, "turning": turning, "best": best}


def _manifest(study: Study) -> dict[str, Any]:
    """All that the results depend on, as JSON."""
    moments = {
        name: [each.crank_angle.tolist(), each.knee.tolist(), each.hip.tolist()] for name, each in study.moments.items()
    }
    return {
        "fes-mj": version("fes-mj"),
        "analysis": study.analysis,
        "chunk": study.chunk,
        "timestep": study.timestep,
        "grid": study.grid,
        "sample": {name: values.tolist() for name, values in study.sample.items()},
        "designs": {name: design_toml(design) for name, design in study.designs.items()},
        "moments": moments,
    }


def evaluate(study: Study, chunk: int) -> Columns:
    """Results of the points of a chunk, a column each; NaN where a linkage does not turn or a run breaks down."""
    columns = study.rows(chunk)
    varied = {name: values for name, values in columns.items() if name in COMPONENTS}
    parts: list[Columns] = []
    for label, design in study.designs.items():
        for name, moments in study.moments.items():
            rows = np.flatnonzero((columns["design"] == label) & (columns["moments"] == name))
            if rows.size:
                values = {variable: column[rows] for variable, column in varied.items()}
                parts.append({"row": rows} | _static(design, values, moments, len(rows)))
                if study.analysis == "dynamic":
                    parts[-1] |= _dynamic(design, values, moments, study.timestep, parts[-1]["turns"])
    order = np.argsort(np.concatenate([part.pop("row") for part in parts]))
    # a varied cadence is a result as well: the same column
    return columns | {name: np.concatenate([part[name] for part in parts])[order] for name in parts[0]}


def _static(design: Design, values: Columns, moments: JointMoments, count: int) -> Columns:
    """Quasi-static results of a batch."""
    batch = replaced(design, {name: column[:, None] for name, column in values.items()})
    turn = cycles(batch, WorkTable.of(moments))
    shape = np.ones(count)  # what does not vary is the same for all points
    own = np.ravel(batch.linkage.cadence) * shape / RPM
    rpm = values.get("cadence_rpm", own)
    cadence = rpm * RPM
    result = {
        "cadence_rpm": rpm,
        "turns": turn.turns & (shape > 0),
        "power_mean_W": turn.work[:, 0] * cadence / (2 * np.pi),
        "work_per_turn_J": turn.work[:, 0] * shape,
    }
    for joint in JOINTS:
        result |= {
            f"{joint}_min_deg": np.degrees(turn.low[joint]) * shape,
            f"{joint}_max_deg": np.degrees(turn.high[joint]) * shape,
            f"mean_{joint}_speed_deg_s": np.degrees(turn.travel[joint]) * cadence / (2 * np.pi),
        }
    return result


def _dynamic(
    design: Design, values: Columns, moments: JointMoments, timestep: float | None, turns: BoolArray
) -> Columns:
    """One simulated turn of every point that turns, the loop in machine code."""
    from fes_mj.simulation.bench import simulate
    from fes_mj.simulation.compiled import compiled_loop

    names = ("simulated_power_mean_W", "loop_gap_max_m", "cadence_ripple", "timestep_s")
    result = {name: np.full(len(turns), np.nan) for name in names}
    for row in np.flatnonzero(turns):
        point = {name: float(column[row]) for name, column in values.items()}
        cadence = point["cadence_rpm"] * RPM if "cadence_rpm" in point else None
        try:
            run = simulate(
                replaced(design, point), moments, cadence=cadence, timestep=timestep, make_loop=compiled_loop
            )
        except (UnstableError, InputError):  # it breaks down, or closes too narrowly to be built
            continue
        measured = (run.power_mean, run.loop_gap_max, run.cadence_ripple, run.timestep)
        for name, value in zip(names, measured, strict=True):
            result[name][row] = value
    return result
