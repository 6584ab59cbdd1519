"""`fes_mj explore` as a process: says its address, ends cleanly, refuses in one message."""

import json
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import pytest

from fes_mj.cli.app import run
from fes_mj.explore.dimensions import content_of
from fes_mj.linkage.design_file import load_design


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
@pytest.mark.parametrize(("how", "code"), [("SIGINT", 130), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_it_serves_until_it_is_stopped_even_during_a_ride(how: str, code: int) -> None:
    with running("r1") as (process, address):
        assert address.startswith("http://127.0.0.1:")
        with urllib.request.urlopen(address, timeout=30) as page:
            assert b"<title>fes_mj explore</title>" in page.read()
        site, _, token = address.partition("?token=")
        question = {"design": content_of(load_design("d1")), "moments": "p1p2"}
        asked = urllib.request.Request(site + "ride", json.dumps(question).encode(), {"X-Token": token})
        with suppress(OSError), urllib.request.urlopen(asked, timeout=30):
            time.sleep(4)  # it takes half a minute
            process.send_signal(getattr(signal, how))
        _, errors = process.communicate(timeout=30)
        assert (process.returncode, errors) == (code, "fes_mj: interrupted; nothing was left half-written\n")


def test_without_the_extra_it_says_what_installs_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    assert run(["explore", "--no-browser"]) == 3
    assert capsys.readouterr().err.endswith("pip install 'fes-mj[explore]'\n")


def test_refusals(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        for arguments, message in (
            (["d1", "--port", str(port)], f"--port {port} is in use by another program"),
            (["d1", "--port", "70000"], '"70000" for --port. Must be <= 65535.'),
            (["d1", "--host", ""], '"" for --host. It must be a name or an address of this machine'),
            (["d7"], "d7: no such design"),
        ):
            assert run(["explore", *arguments, "--no-browser"]) == 2
            errors = capsys.readouterr().err
            assert message in errors
            assert errors.count("\n") == 1
