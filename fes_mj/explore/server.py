"""The page over HTTP, on this machine alone unless asked: its files, and the answers to its questions as JSON."""

import errno
import ipaddress
import json
import threading
import webbrowser
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from socketserver import ThreadingTCPServer
from typing import Any

from fes_mj.common.console import say
from fes_mj.common.errors import InputError, MissingPartError, UnstableError
from fes_mj.common.reading import LARGEST_INPUT
from fes_mj.explore.answers import Answers

_FOLDER = Path(__file__).parent / "page"
_KINDS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}
_FILES = {"/": "page.html", **{f"/{path.name}": path.name for path in _FOLDER.iterdir() if path.suffix != ".html"}}


class Server(ThreadingTCPServer):
    """Each request is answered in a thread of its own, so that a simulation holds up no slider.

    private: whether only this machine can reach it.
    """

    daemon_threads = True
    allow_reuse_address = True  # at once after the last run

    def __init__(self, answers: Answers, host: str, port: int) -> None:
        """Listen. Raises InputError for a port that is taken or an address that is not this machine's."""
        self.answers, self.host = answers, host
        try:
            super().__init__((host, port), Handler)
            self.private = ipaddress.ip_address(str(self.server_address[0])).is_loopback
        except OSError as error:
            if error.errno == errno.EADDRINUSE:
                raise InputError(
                    f"--port {port} is in use by another program; give another, or 0 for any that is free"
                ) from None
            raise InputError(f"cannot listen on {host}, port {port}: {error.strerror}") from None

    @property
    def address(self) -> str:
        """Of the page."""
        return f"http://{self.host}:{self.server_address[1]}"


class Handler(BaseHTTPRequestHandler):
    """GET gives the page's files; POST /NAME with a JSON object asks for the answer of this name."""

    server: Server
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True  # headers and body are sent one after the other: the second must not wait

    def do_GET(self) -> None:
        if self.path not in _FILES:
            return self._send(HTTPStatus.NOT_FOUND, "text/plain", b"there is no such page")
        file = _FOLDER / _FILES[self.path]
        return self._send(HTTPStatus.OK, f"{_KINDS[file.suffix]}; charset=utf-8", file.read_bytes())

    def do_POST(self) -> None:
        status, answer = self._answer()
        self._send(status, "application/json", as_json(answer))

    def _answer(self) -> tuple[HTTPStatus, dict[str, Any]]:
        size = self.headers.get("Content-Length", "")
        if not size.isdecimal() or int(size) > LARGEST_INPUT:
            self.close_connection = True
            return HTTPStatus.REQUEST_ENTITY_TOO_LARGE, {"error": f"at most {LARGEST_INPUT >> 20} MiB can be sent"}
        text, ask = self.rfile.read(int(size)), self.server.answers.by_name.get(self.path.removeprefix("/"))
        if not ask or not self._from_the_page():
            return HTTPStatus.FORBIDDEN, {"error": "only the page itself may ask, and only what it knows"}
        try:
            return HTTPStatus.OK, ask(_question(text))
        except (InputError, UnstableError, MissingPartError) as error:
            return HTTPStatus.BAD_REQUEST, {"error": str(error)}

    def _from_the_page(self) -> bool:
        """Not another site in the same browser: those can neither send JSON nor come here by a name of theirs."""
        host = self.headers.get("Host", "").rpartition(":")[0].strip("[]")
        here = not self.server.private or host in (self.server.host, "localhost")
        return here and self.headers.get_content_type() == "application/json"

    def _send(self, status: HTTPStatus, kind: str, body: bytes) -> None:
        try:
            self.send_response(status)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(body)
        except OSError:  # the page was closed meanwhile
            self.close_connection = True

    def log_message(self, *_: Any) -> None:
        """Nothing: the terminal is for the address."""


def as_json(answer: dict[str, Any]) -> bytes:
    """The answer as the page reads it: arrays are lists, and every number is one that JSON has."""
    return json.dumps(answer, default=lambda array: array.tolist(), allow_nan=False, separators=(",", ":")).encode()


def _question(text: bytes) -> dict[str, Any]:
    try:
        question = json.loads(text)
    except (ValueError, RecursionError):
        question = None
    if not isinstance(question, dict):
        raise InputError("a question must be a JSON object")
    return question


def serve(answers: Answers, host: str, port: int, browser: bool) -> None:
    """Say the address, open it in the browser if wanted, and answer until Ctrl-C (KeyboardInterrupt)."""
    with Server(answers, host, port) as server:
        say(f"The designer's page: {server.address} (Ctrl-C ends it)")
        if browser:
            threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        server.serve_forever()
