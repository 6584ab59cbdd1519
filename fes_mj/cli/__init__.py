"""The command line. This module answers what needs no computing and hands everything else to cli.app."""

import gc
import os
import sys

from fes_mj.cli.process import interruption_code, leave, prepare
from fes_mj.common.errors import InputError

AGREES, DISAGREES, BAD_INPUT, MISSING_PART = 0, 1, 2, 3
FAULT = 70  # of the program itself, as sysexits.h has it
OUT_OF_MEMORY = "there is not enough memory; ask for fewer turns, points or --jobs"
PURPOSE = "Does a pedalling linkage for FES cycling deliver its power when legs have mass and loops must close?"
# The help lines stand here so that `--help` need not import the commands, nor anything else.
EXIT_CODES = "Exit codes: 0 agrees, 1 does not, 2 bad input, 3 a part is missing, 70 a fault, 130 Ctrl-C, 143 SIGTERM."
COMMANDS = {
    "Check a design": {
        "simulate": "Simulate a design in MuJoCo and compare its crank power with statics.",
        "static": "Mean crank power of designs by statics, without MuJoCo.",
        "ride": "Ride a design on a road: does it start, keep going, how fast, up which slope?",
        "validate": "Run every check of the harness on designs, one verdict each; or explain one.",
    },
    "Change it": {
        "explore": "Drag a design's dimensions in the browser and see at once what they do.",
        "fit": "Find the seat for a rider, or who of a population can ride.",
        "optimize": "Find linkages with more crank power, within the paper's limits, and simulate them.",
        "draw": "Drawings, clearances, loads and sizes of a design, for a workshop.",
        "sweep": "Evaluate many designs, riders, cadences and moments; resumes where it was stopped.",
    },
    "Data and export": {
        "moments": "Show what is understood of a file of joint moments, and convert it.",
        "stimulation": "When to stimulate which muscles: crank-angle windows for a stimulator.",
        "export": "Write the MJCF model of a design, for other tools.",
    },
    "The paper": {"reproduce": "Compute the paper's tables and figures and write them beside our own."},
}
GONE = ("--torque-velocity", "--lag")  # options of any command that muscles have made superfluous
MOVED = {"explain": "fes_mj validate --explain CHECK", "view": "fes_mj simulate DESIGN --view"}


def main() -> None:
    """Entry point of the fes_mj command."""
    try:
        prepare()
        # modules and what they define stay: looking through them for garbage, over and over, costs a seventh of a start
        gc.set_threshold(100_000)
        status = _run(sys.argv[1:])
        gc.freeze()
        leave(status)
    except (KeyboardInterrupt, Exception) as error:
        code, message = interruption_code(error), "interrupted; nothing was left half-written"
        if code is None and isinstance(error, InputError | MemoryError):
            code, message = BAD_INPUT, str(error) if isinstance(error, InputError) else OUT_OF_MEMORY
        if code is None:
            sys.excepthook(*sys.exc_info())
            leave(FAULT)
        print(f"fes_mj: {message}", file=sys.stderr)
        leave(code)


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
        # the matrices are small: starting threads for them costs a tenth of a start, and last bits depend on how many
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        from fes_mj.cli.app import run

        return run()
    print(text)
    sys.stdout.flush()
    return AGREES


def _help() -> str:
    rows = {"--help, -h": "Show this, or with a command what it takes.", "--version": "Show the version."}
    lines = ["Usage: fes_mj COMMAND [...]", "", PURPOSE]
    for title, commands in {**COMMANDS, "Everywhere": rows}.items():
        lines += ["", title, *(f"  {name:13}{text}" for name, text in commands.items())]
    return "\n".join([*lines, "", EXIT_CODES, "fes_mj COMMAND --help says more."])
