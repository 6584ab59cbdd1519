"""What a process owes those around it: streams may be closed, full or without a reader; signals let it tidy up."""

from __future__ import annotations

import io
import os
import signal
import sys
import threading
from typing import TYPE_CHECKING, NoReturn, TextIO

from fes_mj.common.errors import InputError

if TYPE_CHECKING:
    from types import FrameType

    from _typeshed import ReadableBuffer


class Outlet(io.FileIO):
    """The bytes of a standard stream, which can lose its reader: the rest goes nowhere, and the run goes on.

    needed: its name, if anything else that stops it, such as a full disk, is an InputError.
    """

    def __init__(self, number: int, needed: str) -> None:
        super().__init__(number, "w", closefd=False)
        self._needed = needed

    def write(self, data: ReadableBuffer) -> int:
        try:
            return super().write(data)
        except OSError as error:
            os.dup2(os.open(os.devnull, os.O_WRONLY), self.fileno())
            if self._needed and not isinstance(error, BrokenPipeError):
                raise InputError(f"{self._needed}: cannot be written: {error.strerror}") from None
            return memoryview(data).nbytes


def _stream(number: int, stream: TextIO | None, needed: str = "") -> TextIO:
    """The stream of this number by way of an Outlet; what its encoding lacks is shown as an escape."""
    buffer = io.BufferedWriter(Outlet(number, needed))
    encoding = stream.encoding if stream else "utf-8"
    return io.TextIOWrapper(buffer, encoding, "backslashreplace", line_buffering=not needed or os.isatty(number))


def prepare() -> None:
    """Make standard streams safe to use, and let signals that end the process raise KeyboardInterrupt(number)."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:  # closed; another file would get its number, and what is printed
            os.open(os.devnull, os.O_RDWR)
    if sys.platform != "win32":  # whose console takes text, not bytes
        sys.stdout, sys.stderr = _stream(1, sys.stdout, "standard output"), _stream(2, sys.stderr)
    sys.unraisablehook = _unraisable
    usual = {"SIGINT": signal.default_int_handler, "SIGTERM": signal.SIG_DFL, "SIGHUP": signal.SIG_DFL}
    for name, default in usual.items():
        kind = getattr(signal, name, None)
        if kind and signal.getsignal(kind) is default:  # `nohup` ignores one
            signal.signal(kind, _interrupt)


_received: list[int] = []  # signals that were to end the process
_leaving = False  # nothing is left to tidy up


def _interrupt(number: int, _: FrameType | None) -> None:
    if _leaving:
        os._exit(128 + number)
    _received.append(number)
    if len(_received) == 1:  # while one is tidying up, another would break into that; a third means it
        raise KeyboardInterrupt(number)
    if len(_received) > 2:
        os._exit(128 + _received[0])


def _unraisable(lost: sys.UnraisableHookArgs) -> None:
    """Python drops what is raised while it clears up an object; a signal that came just then is sent once more."""
    if isinstance(lost.exc_value, KeyboardInterrupt) and _received:
        threading.Timer(0.01, os.kill, (os.getpid(), _received.pop())).start()
    else:
        sys.__unraisablehook__(lost)


def leave(code: int) -> NoReturn:
    """End the process with this exit code; a signal that comes while Python goes ends it at once, with its own."""
    global _leaving
    _leaving = True
    sys.exit(code)


def interruption_code(error: BaseException) -> int | None:
    """Exit code of a run that a signal ended with this error, as a shell shows it: 130 after Ctrl-C, 143 after SIGTERM.

    Compiled code that was loading a module or converting arguments makes an error of its own of KeyboardInterrupt, so
    whatever is raised after a signal was caused by it. None for an error that no signal caused.
    """
    if isinstance(error, KeyboardInterrupt):
        return 128 + (error.args[0] if error.args else signal.SIGINT)
    return 128 + _received[0] if _received else None
