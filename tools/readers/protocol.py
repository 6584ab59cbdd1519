"""What every reader script does: take jobs, measure each model, answer in JSON. Standard library only.

    python READER.py JOBS.json ANSWERS.json

A job names a model file and, if its motion is wanted, how it starts and how it is stepped: `joints` {name: [angle
(rad), speed (rad/s)]} (of the road: m, m/s), `controls` {motor: N m}, `timestep` (s), `samples` (numbers of steps), and
where on the body `shank` the pedal is (m), if that is wanted. The answer says what the reader made of it: `joints`,
`loops`, `free` (degrees of freedom left by the loops), `keeps` (parts of the model by kind), and of the motion
`acceleration` {joint: rad/s^2} at the start, `states` [angles, speeds] at each sample in the order of the joints, and
`pedal` [x, z] (m) at the first; or `error`.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

Job = dict[str, Any]
Answer = dict[str, Any]


def serve(version: str, measure: Callable[[Job], Answer]) -> None:
    """Answer the jobs of the command line; a model that the reader refuses is an answer too."""
    jobs, answers = json.loads(Path(sys.argv[1]).read_text()), []
    for job in jobs:
        try:
            answers.append(measure(job))
        except Exception as error:
            answers.append({"error": f"{type(error).__name__}: {error}".splitlines()[0]})
    Path(sys.argv[2]).write_text(json.dumps({"version": version, "answers": answers}))
