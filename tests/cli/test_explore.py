"""`fes_mj explore` as a process: says its address, ends cleanly, refuses in one message."""

import signal
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from fes_mj.cli.app import run


@contextmanager
def running(*arguments: str) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """The process, and the address that it says."""
    command = [sys.executable, "-m", "fes_mj", "explore", *arguments, "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout
            yield process, process.stdout.readline().split()[3]
        finally:
            process.kill()


@pytest.mark.process
@pytest.mark.skipif(sys.platform == "win32", reason="sends signals")
@pytest.mark.parametrize(("how", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_it_serves_until_it_is_stopped(how: signal.Signals, code: int) -> None:
    with running("r1") as (process, address):
        assert address.startswith("http://127.0.0.1:")
        with urllib.request.urlopen(address, timeout=30) as page:
            assert b"<title>fes_mj explore</title>" in page.read()
        process.send_signal(how)
        _, errors = process.communicate(timeout=30)
        assert (process.returncode, errors) == (code, "fes_mj: interrupted; nothing was left half-written\n")


def test_refusals(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        for arguments, message in (
            (["d1", "--port", str(port)], f"--port {port} is in use by another program"),
            (["d1", "--port", "70000"], '"70000" for --port. Must be <= 65535.'),
            (["d7"], "d7: no such design"),
        ):
            assert run(["explore", *arguments, "--no-browser"]) == 2
            errors = capsys.readouterr().err
            assert message in errors
            assert errors.count("\n") == 1
