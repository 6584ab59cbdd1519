"""The page over HTTP: who may ask, what a bad question gets, and what a run does when nobody waits for it."""

import http.client
import json
import os
import socket
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.explore import server as server_module
from fes_mj.explore.answers import Answers
from fes_mj.explore.dimensions import content_of
from fes_mj.explore.server import HEADERS, Server

D1 = {"design": content_of(fes_mj.load_design("d1"))}


@pytest.fixture
def server(answers: Answers) -> Iterator[Server]:
    server = Server(answers, "127.0.0.1", 0)
    thread = threading.Thread(target=server.run)
    thread.start()
    yield server
    server.should_exit = True
    thread.join()


def token(server: Server) -> str:
    return server.address.rpartition("=")[2]


def port(server: Server) -> int:
    return int(server.listener.getsockname()[1])


def request(server: Server, method: str, path: str, body: str = "", **headers: str) -> tuple[int, Any]:
    connection = http.client.HTTPConnection("127.0.0.1", port(server), timeout=30)
    connection.request(method, path, body, {"X-Token": token(server)} | headers)
    response = connection.getresponse()
    text = response.read().decode()
    connection.close()
    assert {*HEADERS.items()} <= {*response.headers.items()} or {name.lower() for name in HEADERS} <= {
        *response.headers
    }
    return response.status, json.loads(text) if response.headers.get_content_type() == "application/json" else text


def ask(server: Server, name: str, question: Any = None, **headers: str) -> tuple[int, Any]:
    return request(server, "POST", f"/{name}", json.dumps(question or {}), **headers)


@pytest.mark.parametrize("path", ["/", "/page.js", "/runs.js", "/page.css", "/?token=of-another-start"])
def test_the_page(server: Server, path: str) -> None:
    status, text = request(server, "GET", path)
    assert (status, bool(text)) == (200, True)
    assert request(server, "HEAD", path) == (200, "")


def test_nothing_else_is_given(server: Server) -> None:
    for path in ("/nothing", "/../server.py", "/%2e%2e/server.py", "//etc/passwd"):
        assert request(server, "GET", path)[0] == 404
    assert ask(server, "by_name")[0] == 404


def test_questions(server: Server) -> None:
    status, start = ask(server, "start")
    assert status == 200
    status, answer = ask(server, "turn", {"design": start["designs"]["r1"]})
    assert status == 200
    assert len(answer["moments"]["p1p2"]["masses"]) == 360


@pytest.mark.parametrize("body", ["", "[]", "{", "[" * 100_000, '{"design": 1e999}', '{"legs": []}', '{"page": 1}'])
@pytest.mark.parametrize("name", ["turn", "simulate", "open-moments"])
def test_bad_questions(server: Server, name: str, body: str) -> None:
    status, answer = request(server, "POST", f"/{name}", body)
    assert status == 400
    assert answer["error"]


def test_who_may_ask(server: Server) -> None:
    """Nobody without the token, nor with it by a name that is not this machine's."""
    for headers in ({"X-Token": ""}, {"X-Token": "\xe9"}, {"Host": "elsewhere.example:80"}):
        assert ask(server, "start", **headers)[0] == 403
    for host in ("LocalHost:80", "127.0.0.1", "localhost"):
        assert ask(server, "start", Host=host)[0] == 200


def test_too_much(server: Server) -> None:
    assert request(server, "POST", "/start", "", **{"Content-Length": str(2**40)})[0] == 413


def test_a_refusal_shows_little_of_much(server: Server) -> None:
    status, answer = ask(server, "turn", {"legs": "1" * 100_000} | D1)
    assert status == 400
    assert len(answer["error"]) < 1100
    assert answer["error"].startswith("the page: legs is '111")
    assert answer["error"].endswith("it must be 1 or 2")


@pytest.mark.process
def test_a_file_that_is_never_read_to_its_end(server: Server, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Its reader is ended and leaves nothing behind; meanwhile others are answered. Then files are read as ever."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(server_module, "READING", 5)
    slow = {"name": "d.toml", "text": "a." * 60_000 + "a = 1"}  # tomllib takes the square of the dots
    with ThreadPoolExecutor(1) as pool:
        answer = pool.submit(ask, server, "open-design", slow)
        assert ask(server, "turn", D1)[0] == 200
        assert answer.result() == (
            400,
            {"error": "the file could not be read within 5 s; leave out what is not needed of it"},
        )
    assert not [*tmp_path.iterdir()]
    monkeypatch.undo()
    _, saved = ask(server, "save", D1)
    assert ask(server, "open-design", saved) == (200, D1)


def test_an_answer_that_fails_is_an_answer(server: Server, answers: Answers) -> None:
    answers.by_name["save"] = lambda _: {"a number that JSON has not": float("nan")}
    status, answer = ask(server, "save")
    assert status == 500
    assert "ValueError" in answer["error"]


def test_half_of_a_request_is_not_waited_for(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server_module, "REQUEST_PATIENCE", 0.2)
    head = f"POST /start HTTP/1.1\r\nHost: localhost\r\nX-Token: {token(server)}\r\n"
    for half, answer in (("", b""), (head, b""), (f"{head}Content-Length: 9\r\n\r\n{{", b"HTTP/1.1 408")):
        with socket.create_connection(("127.0.0.1", port(server)), timeout=30) as connection:
            connection.sendall(half.encode())
            assert connection.recv(12) == answer


@pytest.mark.long
def test_fifty_at_once(server: Server) -> None:
    with ThreadPoolExecutor(50) as pool:
        answers = [*pool.map(lambda _: ask(server, "turn", D1), range(50))]
    assert [status for status, _ in answers] == [200] * 50
    assert all(answer == answers[0][1] for _, answer in answers)


def test_a_slow_answer_holds_up_no_other(server: Server, answers: Answers) -> None:
    going, asked = threading.Event(), threading.Event()

    def wait(_: Any) -> dict[str, Any]:
        asked.set()
        going.wait(30)
        return {}

    answers.by_name["model"] = wait
    slow = threading.Thread(target=ask, args=(server, "model"))
    slow.start()
    assert asked.wait(30)
    assert ask(server, "start")[0] == 200
    assert slow.is_alive()
    going.set()
    slow.join()


def _count(folder: Path) -> dict[str, Any]:
    """A run that never ends, and shows that it goes on."""
    for number in range(10**9):
        (folder.parent / "alive").write_text(str(number))
        time.sleep(0.02)
    return {}


def _nothing(_: Path) -> dict[str, Any]:
    return {}


@pytest.mark.process
def test_a_run_ends_with_the_one_who_waits_for_it(
    server: Server, answers: Answers, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(answers, "run", lambda *_: _count)
    connection = http.client.HTTPConnection("127.0.0.1", port(server), timeout=30)
    connection.request("POST", "/simulate", "{}", {"X-Token": token(server)})
    alive = tmp_path / "alive"
    deadline = time.monotonic() + 60
    while not alive.exists():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    connection.close()
    while [*tmp_path.iterdir()] != [alive]:  # its folder is gone when it has ended
        assert time.monotonic() < deadline
        time.sleep(0.05)
    count = alive.read_text()
    time.sleep(0.2)
    assert alive.read_text() == count


@pytest.mark.process
def test_runs_wait_for_each_other_and_files_for_none(
    server: Server, answers: Answers, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(answers, "run", lambda *_: _count)
    running = [http.client.HTTPConnection("127.0.0.1", port(server), timeout=60) for _ in range(os.cpu_count() or 8)]
    for connection in running:
        connection.request("POST", "/simulate", "{}", {"X-Token": token(server)})
    deadline = time.monotonic() + 60
    while not (tmp_path / "alive").exists():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    _, saved = ask(server, "save", D1)
    assert ask(server, "open-design", saved) == (200, D1)
    monkeypatch.setattr(answers, "run", lambda *_: _nothing)
    with ThreadPoolExecutor(1) as pool:
        last = pool.submit(request, server, "POST", "/ride", "{}")
        time.sleep(1)  # it waits, as the rest of its answer shows
        for connection in running:
            connection.close()
        first, *_, outcome = last.result()[1].splitlines()
        assert (first, outcome) == ('{"progress":"waits for other runs to end"}', "{}")


def test_a_port_in_use_is_one_message(server: Server, answers: Answers) -> None:
    with pytest.raises(InputError, match=rf"^--port {port(server)} "):
        Server(answers, "127.0.0.1", port(server))


@pytest.mark.parametrize("host", ["192.0.2.1", "no.such.name.invalid", "a" * 70 + ".example", "x\0"])
def test_an_address_of_others(answers: Answers, host: str) -> None:
    with pytest.raises(InputError, match=r"^cannot listen on"):  # 192.0.2.0/24 is TEST-NET, nobody's
        Server(answers, host, 0)


@pytest.mark.skipif(not socket.has_ipv6, reason="this machine has no IPv6")
def test_ipv6(answers: Answers) -> None:
    server = Server(answers, "::1", 0)
    server.listener.close()
    assert server.private
    assert server.address.startswith("http://[::1]:")


def test_an_address_that_others_reach(answers: Answers) -> None:
    server = Server(answers, "0.0.0.0", 0)
    server.listener.close()
    assert not server.private
