"""The command line. This module answers what needs no computing and hands everything else to cli.app."""

import gc
import os
import sys

from fes_mj.cli.process import interruption_code, prepare
from fes_mj.common.errors import InputError

AGREES, DISAGREES, BAD_INPUT, MISSING_PART = 0, 1, 2, 3
PURPOSE = "Does a pedalling linkage for FES cycling deliver its power when legs have mass and loops must close?"
# The help lines stand here so that `--help` need not import the commands, nor anything else.
EXIT_CODES = "Exit codes: 0 agrees, 1 does not, 2 bad input, 3 a needed part is missing, 130 Ctrl-C, 143 SIGTERM."
COMMANDS = {
    "simulate": "Simulate a design in MuJoCo and compare its crank power with statics.",
    "ride": "Ride a design on a road: does it start, keep going, how fast, up which slope?",
    "static": "Mean crank power of a design by statics, without MuJoCo.",
    "optimize": "Find linkages with more crank power, within the paper's limits, and simulate them.",
    "fit": "Find the seat for a rider, or who of a population can ride.",
    "sweep": "Evaluate many designs, riders, cadences and moments; resumes where it was stopped.",
    "export": "Write the MJCF model of a design, for other tools.",
    "validate": "Run every check of the harness on designs, one verdict each.",
    "explain": "What a check guards against and what usually breaks it.",
    "reproduce": "Compute the paper's tables and figures and write them beside our own.",
    "moments": "Show what is understood of a file of joint moments, and convert it.",
    "stimulation": "When to stimulate which muscles: crank-angle windows for a stimulator.",
    "explore": "Drag a design's dimensions in the browser and see at once what they do.",
    "view": "Watch a design run in MuJoCo's interactive viewer.",
}


def main() -> None:
    """Entry point of the fes_mj command."""
    try:
        prepare()
        # modules and what they define stay: looking through them for garbage, over and over, costs a seventh of a start
        gc.set_threshold(100_000)
        status = _run(sys.argv[1:])
        gc.freeze()
        sys.exit(status)
    except (KeyboardInterrupt, Exception) as error:
        code = interruption_code(error)
        if code is None and not isinstance(error, InputError):
            raise
        print(f"fes_mj: {error if code is None else 'interrupted; nothing was left half-written'}", file=sys.stderr)
        sys.exit(BAD_INPUT if code is None else code)


def _run(arguments: list[str]) -> int:
    if arguments in ([], ["--help"], ["-h"]):
        text = _help()
    elif arguments == ["--version"]:
        from importlib.metadata import version

        text = version("fes-mj")
    else:
        # keeps `import mujoco` from loading OpenGL, which may be absent; rendering puts the user's choice back
        os.environ["FES_MJ_GL"] = os.environ.get("MUJOCO_GL", "")
        os.environ["MUJOCO_GL"] = "disable"
        from fes_mj.cli.app import run

        return run()
    print(text)
    sys.stdout.flush()
    return AGREES


def _help() -> str:
    rows = [
        *COMMANDS.items(),
        ("--help, -h", "Show this, or with a command what it takes."),
        ("--version", "Show the version."),
    ]
    lines = [f"  {name:12}{text}" for name, text in rows]
    return "\n".join(
        ["Usage: fes_mj COMMAND [...]", "", PURPOSE, "", *lines, "", EXIT_CODES, "fes_mj COMMAND --help says more."]
    )
