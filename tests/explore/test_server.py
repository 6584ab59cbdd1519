"""The page over HTTP: who may ask, and what a bad question gets."""

import http.client
import json
import threading
from collections.abc import Iterator
from typing import Any

import pytest

from fes_mj.common.errors import InputError
from fes_mj.explore.answers import Answers
from fes_mj.explore.server import Server


@pytest.fixture
def server(answers: Answers) -> Iterator[Server]:
    with Server(answers, "127.0.0.1", 0) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        yield server
        server.shutdown()
        thread.join()


def request(server: Server, method: str, path: str, body: str = "", **headers: str) -> tuple[int, Any]:
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=30)
    connection.request(method, path, body, {"Content-Type": "application/json"} | headers)
    response = connection.getresponse()
    text = response.read().decode()
    connection.close()
    return response.status, json.loads(text) if response.headers.get_content_type() == "application/json" else text


@pytest.mark.parametrize("path", ["/", "/page.js", "/runs.js", "/page.css"])
def test_the_page(server: Server, path: str) -> None:
    status, text = request(server, "GET", path)
    assert (status, bool(text)) == (200, True)


def test_nothing_else_is_given(server: Server) -> None:
    for path in ("/nothing", "/../server.py", "/page.html"):
        assert request(server, "GET", path)[0] == 404
    assert request(server, "POST", "/by_name", "{}")[0] == 403


def test_questions(server: Server) -> None:
    status, start = request(server, "POST", "/start", "{}")
    assert status == 200
    status, answer = request(server, "POST", "/turn", json.dumps({"design": start["designs"]["r1"]}))
    assert status == 200
    assert len(answer["moments"]["p1p2"]["masses"]) == 360


@pytest.mark.parametrize("body", ["", "[]", "{", "[" * 100_000, '{"design": 1e999}'])
def test_bad_questions(server: Server, body: str) -> None:
    status, answer = request(server, "POST", "/turn", body)
    assert status == 400
    assert answer["error"]


def test_other_sites_cannot_ask(server: Server) -> None:
    """They cannot send JSON to us without our leave, and under a name of their own they are no page of ours."""
    for headers in ({"Content-Type": "text/plain"}, {"Host": "elsewhere.example:80"}):
        assert request(server, "POST", "/start", "{}", **headers)[0] == 403
    assert request(server, "POST", "/start", "{}", Host="localhost:80")[0] == 200


def test_too_much(server: Server) -> None:
    assert request(server, "POST", "/start", "", **{"Content-Length": str(2**40)})[0] == 413


def test_a_slow_answer_holds_up_no_other(server: Server, answers: Answers) -> None:
    going, asked = threading.Event(), threading.Event()

    def wait(_: dict[str, Any]) -> dict[str, Any]:
        asked.set()
        going.wait(30)
        return {}

    answers.by_name["simulate"] = wait
    slow = threading.Thread(target=request, args=(server, "POST", "/simulate", "{}"))
    slow.start()
    assert asked.wait(30)
    assert request(server, "POST", "/start", "{}")[0] == 200
    assert slow.is_alive()
    going.set()
    slow.join()


def test_a_port_in_use_is_one_message(server: Server, answers: Answers) -> None:
    port = server.server_address[1]
    with pytest.raises(InputError, match=rf"^--port {port} "):
        Server(answers, "127.0.0.1", port)


def test_an_address_of_others(answers: Answers) -> None:
    with pytest.raises(InputError, match=r"192\.0\.2\.1, port 0"):  # TEST-NET, nobody's
        Server(answers, "192.0.2.1", 0)
