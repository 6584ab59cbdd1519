"""Parsing a command line, running the command, and the exit code that says how it went."""

import sys
from collections.abc import Sequence

from cyclopts import App, CycloptsError

from fes_mj.cli import AGREES, BAD_INPUT, COMMANDS, DISAGREES, GONE, MISSING_PART, MOVED, OUT_OF_MEMORY, PURPOSE
from fes_mj.cli.process import interruption_code
from fes_mj.common.console import errors
from fes_mj.common.errors import InputError, MissingPartError, UnstableError
from fes_mj.common.text import printable

ERROR_CODES = {
    CycloptsError: BAD_INPUT,
    InputError: BAD_INPUT,
    OSError: BAD_INPUT,
    MemoryError: BAD_INPUT,
    MissingPartError: MISSING_PART,
    UnstableError: DISAGREES,
}
OPTIONAL = {"validate": "[DESIGN...]", "explore": "[DESIGN]"}  # arguments, which would be called ARGS
LONGEST_MESSAGE = 1000  # characters

app = App(name="fes_mj", help=PURPOSE, suppress_keyboard_interrupt=False)
for _group, _commands in COMMANDS.items():
    for _command, _help in _commands.items():
        _usage = _command in OPTIONAL and f"Usage: fes_mj {_command} [OPTIONS] {OPTIONAL[_command]}"
        app.command(f"fes_mj.cli.{_command}:{_command}", name=_command, help=_help, group=_group, usage=_usage or None)
app.command(
    "fes_mj.cli.completion:install_completion",
    name="--install-completion",
    help="Install shell completion: a script that answers without starting fes_mj.",
)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run one command line and return its exit code; every expected failure becomes one message on standard error."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments and (now := MOVED.get(arguments[0])):
        _say(f"{arguments[0]} is now `{now}`")
        return BAD_INPUT
    if gone := next((flag for flag in GONE if flag in [argument.partition("=")[0] for argument in arguments]), None):
        _say(
            f"{gone} is gone: moments are the same at any speed, at once; give --drive muscles for muscles that are not"
        )
        return BAD_INPUT
    try:
        code = app(arguments, exit_on_error=False, print_error=False, result_action="return_value")
        sys.stdout.flush()
        return code if isinstance(code, int) else AGREES
    except Exception as error:
        code = next((code for kind, code in ERROR_CODES.items() if isinstance(error, kind)), None)
        if code is None or interruption_code(error) is not None:
            raise
        if isinstance(error, MemoryError):
            error = InputError(OUT_OF_MEMORY)
        _say(f"{error.filename or 'a file'}: {error.strerror or error}" if isinstance(error, OSError) else error)
        return code


def _say(message: object) -> None:
    text = printable(str(message))
    if len(text) > LONGEST_MESSAGE:  # quoted input can be as long as the file
        text = f"{text[: LONGEST_MESSAGE // 2]} ... {text[-LONGEST_MESSAGE // 2 :]}"
    errors.print(f"fes_mj: {text}", soft_wrap=True)
