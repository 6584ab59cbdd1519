"""Sweeps: a study evaluated in chunks, each a Parquet file that appears whole; what is there is not done again."""

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.parallel import HERE, Workers, run_tasks
from fes_mj.common.provenance import digest
from fes_mj.common.reading import read_json
from fes_mj.common.writing import make_folder, remove_leftovers, replacing, require_writable, write_text
from fes_mj.linkage.design_file import design_toml
from fes_mj.sweep.evaluation import column_types, evaluate
from fes_mj.sweep.study import Study, load_study

MANIFEST = "study.json"
TOP = 10  # points of a summary
# What file browsers and file systems put into a folder; names with a leading dot are hidden as well.
NOBODYS_FILES = ("thumbs.db", "ehthumbs.db", "desktop.ini", "icon\r", "lost+found", "__macosx")


@dataclass(frozen=True, repr=False)
class Sweep(Brief):
    """A study and the folder of its results."""

    study: Study
    folder: Path

    @property
    def brief(self) -> str:
        return f"{self.study.files[0].name} in {self.folder}: {self.study.points:,} points"

    def path(self, chunk: int) -> Path:
        """File of a chunk."""
        return self.folder / f"chunk-{chunk:07d}.parquet"

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """All that the results depend on, as JSON, of long arrays a digest. The order of the grid is part of it."""
        study, muscles = self.study, self.study.muscles
        return {
            "fes-mj": version("fes-mj"),
            "analysis": study.analysis,
            "chunk": study.chunk,
            "timestep": study.timestep,
            "characteristics": study.characteristics,
            "legs": study.legs,
            "grid": study.grid,
            "sample": {name: digest(values) for name, values in study.sample.items()},
            "designs": {name: design_toml(design) for name, design in study.designs.items()},
            "moments": {name: digest(moments) for name, moments in study.moments.items()},
        } | ({"muscles": digest(muscles)} if muscles else {})

    def schema(self, chunk: int) -> Any:
        """The pyarrow schema of a chunk, marked with study and number: a file of another chunk has another."""
        arrow = require_extra("optimize", "pyarrow")
        types = {int: arrow.int64(), float: arrow.float64(), bool: arrow.bool_(), str: arrow.string()}
        fields = [(name, types[kind]) for name, kind in column_types(self.study).items()]
        return arrow.schema(fields, {"fes_mj.study": self._mark, "fes_mj.chunk": str(chunk)})

    @cached_property
    def _mark(self) -> str:
        return digest(json.dumps(self.manifest))

    def table(self, chunk: int) -> Any:
        """Rows of a chunk as a pyarrow table; None unless its file is there, undamaged, and this chunk's."""
        arrow, parquet = require_extra("optimize", "pyarrow"), require_extra("optimize", "pyarrow.parquet")
        schema, numbers = self.schema(chunk), self.study.numbers(chunk)
        try:
            with parquet.ParquetFile(self.path(chunk), page_checksum_verification=True) as file:
                if not file.schema_arrow.equals(schema, check_metadata=True) or file.metadata.num_rows != len(numbers):
                    return None
                table = file.read()
        except (OSError, ValueError, arrow.ArrowException):  # what damage makes of it
            return None
        return table if np.array_equal(table["point"].to_numpy(), numbers) else None

    def tables(self) -> Iterator[tuple[int, Any]]:
        """The finished chunks, whose results are there and sound, in their order, each with its table."""
        for chunk in range(self.study.chunks):
            if self.path(chunk).exists() and (table := self.table(chunk)) is not None:
                yield chunk, table

    def finished(self) -> list[int]:
        """The finished chunks."""
        return [chunk for chunk, _ in self.tables()]

    def claim(self) -> None:
        """Make the folder this study's, or check that it is; remove what a kill left. InputError if it is another's."""
        make_folder(self.folder, "the results")
        manifest, ours = self.folder / MANIFEST, self.manifest
        if manifest.exists():
            theirs = read_json(manifest, "record of the study")
            different = [
                key if ours.get(key) != theirs.get(key) else f"order of {key}"
                for key in ours | theirs
                if json.dumps(ours.get(key)) != json.dumps(theirs.get(key))
            ]
            if different:
                raise InputError(
                    f"{self.folder}: this folder holds the results of another study (different: "
                    f"{', '.join(different)}); name another folder"
                )
        elif any(not _is_nobodys(path) for path in self.folder.iterdir()):
            raise InputError(f"{self.folder}: this folder is not empty and holds no study; name a new one")
        else:
            write_text(manifest, json.dumps(ours, indent=1))
        remove_leftovers(self.folder)

    def release(self) -> None:
        """Remove the record of a study of which nothing was computed."""
        if not any(self.folder.glob("chunk-*")):
            (self.folder / MANIFEST).unlink(missing_ok=True)

    def run(
        self,
        workers: Workers = HERE,
        progress: Callable[[int], None] | None = None,
        finished: Sequence[int] | None = None,
    ) -> None:
        """Evaluate the chunks that are not there yet; progress: called with the points of each new chunk.

        finished: as finished(), where that is known already.
        """
        arrow, parquet = require_extra("optimize", "pyarrow"), require_extra("optimize", "pyarrow.parquet")
        self.claim()
        present = {*(self.finished() if finished is None else finished)}
        missing = [chunk for chunk in range(self.study.chunks) if chunk not in present]
        for chunk in missing:
            require_writable(self.path(chunk), "a chunk")
        for index, columns in run_tasks(partial(evaluate, self.study), missing, workers):
            schema = self.schema(missing[index])
            # NaN, for what could not be computed, becomes null
            arrays = [arrow.array(columns[field.name], field.type, from_pandas=True) for field in schema]
            with replacing(self.path(missing[index])) as temporary:
                parquet.write_table(arrow.table(arrays, schema=schema), temporary, write_page_checksum=True)
            if progress:
                progress(len(columns["point"]))

    def read(self, columns: Sequence[str] | None = None) -> Any:
        """All finished results, or these of their columns, as one pyarrow table, by point."""
        arrow = require_extra("optimize", "pyarrow")
        tables = [self.schema(0).empty_table(), *(table for _, table in self.tables())]
        parts = [table.select(columns or table.column_names) for table in tables]
        return arrow.concat_tables(parts).replace_schema_metadata()

    def write_csv(self, path: Path) -> None:
        """All finished results as a CSV file, empty where something is not known."""
        csv = require_extra("optimize", "pyarrow.csv")
        with replacing(path) as temporary, csv.CSVWriter(temporary, self.schema(0)) as writer:
            for _, table in self.tables():
                writer.write_table(table)

    def summary(self) -> dict[str, Any]:
        """Numbers of points, the TOP ones with the most mean crank power, and why there is none, if there is none."""
        points, turning, computed, why, top = 0, 0, 0, None, []
        for _, table in self.tables():
            points, turning = points + table.num_rows, turning + int(np.sum(table["turns"].to_numpy()))
            refused = table["why"].drop_null()
            computed += table.num_rows - len(refused)
            why = why or (refused[0].as_py() if len(refused) else None)
            order = np.argsort(-table["power_mean_W"].to_numpy(), kind="stable")[:TOP]  # NaN, for null, comes last
            top += [row for row in table.take(order).to_pylist() if row["power_mean_W"] is not None]
            top = sorted(top, key=lambda row: -float(row["power_mean_W"]))[:TOP]
        best = top[0] if top else None
        counts = {"points": points, "turning": turning, "computed": computed, "why": None if computed else why}
        return {"folder": str(self.folder), **counts, "best": best, "best_at_end_of": self._ends(best), "top": top}

    def _ends(self, best: dict[str, Any] | None) -> list[str]:
        """Which varied numbers have, at the best point, the first or last of their values: the best may lie beyond."""
        values = self.study.grid | self.study.sample
        return [
            axis for axis in self.study.varied_numbers if best and best[axis] in (min(values[axis]), max(values[axis]))
        ]


def run_sweep(study: str | Path, folder: str | Path, workers: Workers = HERE) -> Sweep:
    r"""Evaluate every point of a study file (.toml) into a folder; what is there already is not done again.

    Raises InputError for what the study must not say and for a folder of another study, MissingPartError without
    pyarrow.

    >>> study = folder / "cranks.toml"
    >>> _ = study.write_text('[grid]\ndesign = ["d1", "r2"]\nR2 = [0.05, 0.06, 0.07]')
    >>> sweep = fes_mj.run_sweep(study, folder / "results")
    >>> sweep.summary()["points"], sweep.read(["power_mean_W"]).num_rows
    (6, 6)
    """
    sweep = Sweep(load_study(Path(study)), Path(folder))
    sweep.run(workers)
    return sweep


def _is_nobodys(path: Path) -> bool:
    """Whether a file is hidden or a file browser's, so that a folder with nothing else is empty to its user."""
    return path.name.startswith(".") or path.name.lower() in NOBODYS_FILES
