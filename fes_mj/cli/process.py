"""What a process owes those around it: streams may be closed, full or without a reader; signals let it tidy up."""

import io
import os
import signal
import sys
from types import FrameType
from typing import NoReturn, TextIO

from fes_mj.errors import InputError


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
    for name in ("SIGTERM", "SIGHUP"):
        kind = getattr(signal, name, None)
        if kind and signal.getsignal(kind) is signal.SIG_DFL:  # `nohup` ignores one
            signal.signal(kind, _interrupt)


def _interrupt(number: int, _: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt(number)


def interruption_code(error: BaseException) -> int:
    """Exit code of an interrupted run, as a shell shows it: 130 after Ctrl-C, 143 after SIGTERM, 129 after SIGHUP."""
    return 128 + (error.args[0] if error.args else signal.SIGINT)


def interruption_behind(error: BaseException) -> KeyboardInterrupt | None:
    """The interruption that came while somebody else's code was running, which made another error of it, if any did.

    A compiled module that was being loaded names it as the cause; ctypes, whose arguments were being converted, only in
    its text.
    """
    import re  # help needs neither
    from ctypes import ArgumentError

    cause: BaseException | None = error
    while cause:
        if isinstance(cause, KeyboardInterrupt):
            return cause
        cause = cause.__cause__
    named = re.search(r"KeyboardInterrupt: ?(\d*)", str(error)) if isinstance(error, ArgumentError) else None
    return KeyboardInterrupt(*map(int, filter(None, named.groups()))) if named else None
