"""What a process owes those around it: streams may be closed, full or without a reader; signals let it tidy up."""

import io
import os
import signal
import sys
from types import FrameType
from typing import NoReturn, TextIO

from fes_mj.common.errors import InputError


class Stream(io.TextIOWrapper):
    """A standard stream that can lose its reader: what is then said goes nowhere, and the run goes on.

    needed: whether anything else that stops it, such as a full disk, is an InputError.
    """

    def __init__(self, stream: TextIO, needed: str = "") -> None:
        line_buffering, encoding = stream.isatty() or not needed, stream.encoding
        super().__init__(stream.detach(), encoding, "backslashreplace", line_buffering=line_buffering)  # type: ignore[attr-defined]
        self._needed = needed

    def write(self, text: str) -> int:
        try:
            return super().write(text)
        except OSError as error:
            self._give_up(error)
            return len(text)

    def flush(self) -> None:
        try:
            super().flush()
        except OSError as error:
            self._give_up(error)

    def _give_up(self, error: OSError) -> None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), self.fileno())
        if self._needed and not isinstance(error, BrokenPipeError):
            raise InputError(f"{self._needed}: cannot be written: {error.strerror}") from None


def prepare() -> None:
    """Make standard streams safe to use, and let signals that end the process raise KeyboardInterrupt(number)."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:  # closed; another file would get its number, and what is printed
            os.open(os.devnull, os.O_RDWR)
    sys.stdout = Stream(sys.stdout or os.fdopen(1, "w", encoding="utf-8"), "standard output")
    sys.stderr = Stream(sys.stderr or os.fdopen(2, "w", encoding="utf-8"))
    for name, default in (
        ("SIGINT", signal.default_int_handler),
        ("SIGTERM", signal.SIG_DFL),
        ("SIGHUP", signal.SIG_DFL),
    ):
        kind = getattr(signal, name, None)
        if kind and signal.getsignal(kind) is default:  # `nohup` ignores one
            signal.signal(kind, _interrupt)


_received: list[int] = []  # signals that were to end the process


def _interrupt(number: int, _: FrameType | None) -> NoReturn:
    _received.append(number)
    raise KeyboardInterrupt(number)


def interruption_code(error: BaseException) -> int | None:
    """Exit code of a run that a signal ended with this error, as a shell shows it: 130 after Ctrl-C, 143 after SIGTERM.

    Compiled code that was loading a module or converting arguments makes an error of its own of KeyboardInterrupt, so
    whatever is raised after a signal was caused by it. None for an error that no signal caused.
    """
    if isinstance(error, KeyboardInterrupt):
        return 128 + (error.args[0] if error.args else signal.SIGINT)
    return 128 + _received[0] if _received else None
