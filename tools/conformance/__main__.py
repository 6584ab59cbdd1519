"""Which tools read the exported models, and how well: run every reader, compare with MuJoCo, write results/readers.*.

    python -m tools.conformance [READER ...]

A reader runs in this environment or in its own, .readers/READER, which `python -m tools.conformance.build` makes;
without one it is left out, and the results are only printed. Exit code 1 if a reader does not keep what it can be held
to.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import asdict
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from fes_mj.common.provenance import provenance
from fes_mj.common.writing import json_text, write_text
from fes_mj.linkage.design_file import DESIGNS, load_design
from tools.conformance.asking import ROOT, interpreter, reference, rows
from tools.conformance.judging import Row
from tools.conformance.motions import jobs
from tools.conformance.readers import READERS
from tools.conformance.table import HEADING, table

RESULTS = ROOT / "results"


def main() -> int:
    arguments = sys.argv[1:]
    unknown = [argument for argument in arguments if argument not in READERS]
    if unknown:
        print(f"unknown reader {unknown[0]!r}; it must be one of {', '.join(READERS)}", file=sys.stderr)
        return 2
    chosen = arguments or [*READERS]
    designs, judged = [load_design(name) for name in DESIGNS], list[Row]()
    console = Console(stderr=True)
    with tempfile.TemporaryDirectory() as folder, Progress(console=console, transient=True) as progress:
        tasks = jobs(designs, Path(folder))
        references = reference(tasks)
        for name in progress.track(chosen, description="readers"):
            if interpreter(name) is None:
                console.print(f"{name}: not installed, left out; `make readers` installs it where it can be had")
            else:
                judged += rows(name, tasks, references)
    print(table(judged))
    if {row.reader for row in judged} == {*READERS}:
        record = {"provenance": provenance(), "rows": [asdict(row) | {"ok": row.ok} for row in judged]}
        write_text(RESULTS / "readers.json", json_text(record))
        write_text(RESULTS / "readers.md", HEADING + table(judged))
    return 0 if all(row.ok for row in judged) else 1


if __name__ == "__main__":
    sys.exit(main())
