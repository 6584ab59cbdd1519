"""The command line: what is asked for, what is shown, and which exit code says how it went."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from cyclopts import App, CycloptsError

from fes_mj.cli.output import errors
from fes_mj.errors import InputError, MissingPartError, UnstableError
from fes_mj.headless import defer_gl

AGREES, DISAGREES, BAD_INPUT, MISSING_PART, INTERRUPTED = 0, 1, 2, 3, 130

INTERRUPTION = "interrupted; nothing was left half-written"
LONGEST_MESSAGE = 1000  # characters

app = App(
    name="fes_mj",
    help="Does a pedalling linkage for FES cycling deliver its power when legs have mass and loops must close?",
    suppress_keyboard_interrupt=False,
)
# The help lines stand here so that `--help` need not import the commands.
_COMMANDS = {
    "simulate": "Simulate a design in MuJoCo and compare its crank power with statics.",
    "static": "Mean crank power of a design by statics, without MuJoCo.",
    "optimize": "Find linkages with more crank power, within the paper's limits, and simulate them.",
    "sweep": "Evaluate many designs, riders, cadences and moments; resumes where it was stopped.",
    "export": "Write the MJCF model of a design, for other tools.",
    "validate": "Run every check of the harness on designs, one verdict each.",
    "explain": "What a check guards against and what usually breaks it.",
    "reproduce": "Compute the paper's tables and figures and write them beside our own.",
    "view": "Watch a design run in MuJoCo's interactive viewer.",
}
for _command, _help in _COMMANDS.items():
    app.command(f"fes_mj.cli.{_command}:{_command}", name=_command, help=_help)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run one command line and return its exit code; every expected failure becomes one message on standard error."""
    try:
        code = app(arguments, exit_on_error=False, print_error=False, result_action="return_value")
        return code if isinstance(code, int) else AGREES
    except (CycloptsError, InputError) as error:
        return _fail(error, BAD_INPUT)
    except MissingPartError as error:
        return _fail(error, MISSING_PART)
    except UnstableError as error:
        return _fail(error, DISAGREES)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the reader left; nothing more to say
        return DISAGREES
    except OSError as error:
        return _fail(f"{error.filename or 'output'}: {error.strerror}", BAD_INPUT)
    except KeyboardInterrupt:
        return _fail(INTERRUPTION, INTERRUPTED)
    except ImportError as error:
        cause: BaseException | None = error
        while cause and not isinstance(cause, KeyboardInterrupt):
            cause = cause.__cause__
        if cause is None:
            raise
        return _fail(INTERRUPTION, INTERRUPTED)  # it came while a compiled module was being loaded


def _fail(message: object, code: int) -> int:
    text = str(message)
    if len(text) > LONGEST_MESSAGE:  # quoted input can be as long as the file
        text = f"{text[: LONGEST_MESSAGE // 2]} ... {text[-LONGEST_MESSAGE // 2 :]}"
    errors.print(f"fes_mj: {text}", markup=False, highlight=False, soft_wrap=True)
    return code


def main() -> None:
    """Entry point of the fes_mj command."""
    defer_gl()
    sys.exit(run())
