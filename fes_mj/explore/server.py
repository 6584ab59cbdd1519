"""The page over HTTP, on this machine alone unless asked: its files, and the answers to its questions as JSON."""

import asyncio
import errno
import ipaddress
import json
import logging
import secrets
import socket
import threading
import webbrowser
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import anyio
import anyio.from_thread
import anyio.to_process
import anyio.to_thread
import h11
import uvicorn
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.middleware.body_limit import RequestBodyLimitMiddleware
from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles
from uvicorn.protocols.http.h11_impl import H11Protocol

from fes_mj.common.console import complain, say
from fes_mj.common.errors import InputError, MissingPartError, UnstableError
from fes_mj.explore.answers import Answers, Reply, as_question
from fes_mj.explore.runs import RUNS, progress

REQUEST_PATIENCE = 10  # s, for the head of a request, then for its body, then for the next one on the same connection
READING = 60  # s, for a file
LARGEST_QUESTION = 16 * 2**20  # bytes: more than ten minutes of a trial as OpenSim writes it
LONGEST_SENTENCE = 1000  # characters of a refusal, which may show what was sent
CONNECTIONS = 200  # at a time
RUNNING, WAITING = "running\N{HORIZONTAL ELLIPSIS}", "waits for other runs to end"
TICK = 0.5  # s between two looks at how far a run has come
HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "Referrer-Policy": "no-referrer",  # the address holds the token
    "X-Content-Type-Options": "nosniff",
}
REFUSALS = (InputError, UnstableError, MissingPartError)
_PAGE = Path(__file__).parent / "page"
_LOG = logging.getLogger(__name__)


def application(answers: Answers, token: str, hosts: set[str] | None) -> Starlette:
    """The page's files by GET; a POST of a JSON object to /NAME, with the token as X-Token, gets the answer NAME.

    hosts: the names, in lower case, under which the page is reached; None for any. Runs answer line by line: objects
    with "progress", then the answer or an object with "error".
    """
    answers.reader = _apart

    async def ask(request: Request) -> Response:
        here = hosts is None or request.url.hostname in hosts
        if not here or not secrets.compare_digest(request.headers.get("x-token", "").encode(), token.encode()):
            raise HTTPException(403, "only the page may ask: open the address that fes_mj explore has printed")
        try:
            with anyio.fail_after(REQUEST_PATIENCE):
                body = await request.body()
        except TimeoutError:
            raise HTTPException(408, f"the question did not come within {REQUEST_PATIENCE} s") from None
        name, question = request.path_params["name"], as_question(body)
        if name in RUNS:
            return StreamingResponse(_lines(answers.run(name, question)), media_type="application/x-ndjson")
        if name not in answers.by_name:
            raise HTTPException(404, f"the page cannot ask for {name!r}")
        answer = await anyio.to_thread.run_sync(lambda: encoded(answers.by_name[name](question)))
        return Response(answer, media_type="application/json")

    return Starlette(
        routes=[Route("/{name}", ask, methods=["POST"]), Mount("/", StaticFiles(directory=_PAGE, html=True))],
        middleware=[Middleware(RequestBodyLimitMiddleware, max_body_size=LARGEST_QUESTION)],
        exception_handlers=dict.fromkeys((HTTPException, *REFUSALS, Exception), _refuse),
    )


def _apart(load: Callable[[Path], Any], path: Path) -> Any:
    """What `load` gives, from a process of its own that may take READING s: for the threads of questions."""

    async def loaded() -> Any:
        with anyio.fail_after(READING):
            limiter = anyio.CapacityLimiter(1)  # runs, of which so many go on as there are cores, hold up no file
            return await anyio.to_process.run_sync(load, path, cancellable=True, limiter=limiter)

    try:
        return anyio.from_thread.run(loaded)
    except TimeoutError:
        raise InputError(f"the file could not be read within {READING} s; leave out what is not needed of it") from None


async def _lines(run: Callable[[Path], Reply]) -> AsyncIterator[bytes]:
    """Progress of a run in a process of its own, and its answer; the process ends when nobody listens any more."""
    with TemporaryDirectory() as folder:
        work = asyncio.create_task(anyio.to_process.run_sync(run, Path(folder), cancellable=True))
        limiter, shown = anyio.to_process.current_default_process_limiter(), RUNNING
        try:
            while not (await asyncio.wait([work], timeout=TICK))[0]:
                text = (progress(Path(folder)) or RUNNING) if work in limiter.statistics().borrowers else WAITING
                if text != shown:
                    yield encoded({"progress": text}) + b"\n"
                shown = text
            yield encoded(work.result())
        except Exception as error:
            _LOG.error("a run failed", exc_info=error)
            yield encoded({"error": _refusal(error)[1]})
        finally:
            work.cancel()
            with anyio.CancelScope(shield=True):  # until it has ended: its folder goes next
                await asyncio.wait([work])


async def _refuse(_: Request, error: Exception) -> Response:
    status, sentence = _refusal(error)
    return Response(encoded({"error": sentence}), status, media_type="application/json")


def _refusal(error: Exception) -> tuple[int, str]:
    """Status and sentence of an answer that there is not."""
    if isinstance(error, HTTPException):
        return error.status_code, error.detail
    if isinstance(error, REFUSALS):
        sentence, most = str(error), LONGEST_SENTENCE // 2
        return 400, sentence if len(sentence) <= 2 * most else f"{sentence[:most]} [...] {sentence[-most:]}"
    return 500, f"fes_mj failed at this ({type(error).__name__}: {error}); with --debug its terminal says where"


def encoded(answer: Reply) -> bytes:
    """The answer as the page reads it: arrays are lists, and every number is one that JSON has."""
    return json.dumps(answer, default=lambda array: array.tolist(), allow_nan=False, separators=(",", ":")).encode()


class Protocol(H11Protocol):
    """HTTP of which a request's head must be whole in time: uvicorn itself waits for the rest of one for ever."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self.timeout_keep_alive_task = self.loop.call_later(REQUEST_PATIENCE, self.timeout_keep_alive_handler)

    def data_received(self, data: bytes) -> None:
        timer, self.timeout_keep_alive_task = self.timeout_keep_alive_task, None  # or any byte would stop it
        super().data_received(data)
        if timer and self.conn.their_state is h11.IDLE:
            self.timeout_keep_alive_task = timer
        elif timer:
            timer.cancel()


class Server(uvicorn.Server):
    """Listens from the beginning, and answers when it runs.

    private: whether only this machine can reach it. address: of the page, with its token.
    """

    def __init__(self, answers: Answers, host: str, port: int) -> None:
        """Raises InputError for a port that is taken or an address that is not this machine's."""
        self.listener, token = _listen(host, port), secrets.token_urlsafe(16)
        ip, port = self.listener.getsockname()[:2]
        self.private = ipaddress.ip_address(ip).is_loopback
        self.address = f"http://{f'[{host}]' if ':' in host else host}:{port}/?token={token}"
        hosts = {host.lower(), ip, "localhost"} if self.private else None
        config = uvicorn.Config(
            application(answers, token, hosts),
            http=Protocol,
            ws="none",
            lifespan="off",
            log_config=None,
            headers=[*HEADERS.items()],
            server_header=False,
            limit_concurrency=CONNECTIONS,
            timeout_keep_alive=REQUEST_PATIENCE,
            timeout_graceful_shutdown=1,
        )
        super().__init__(config)

    def run(self, sockets: list[socket.socket] | None = None) -> None:
        super().run(sockets or [self.listener])


def _listen(host: str, port: int) -> socket.socket:
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        return socket.create_server(address, family=family)
    except (OSError, ValueError) as error:  # ValueError: a name that none can be
        if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
            raise InputError(
                f"--port {port} is in use by another program; give another, or 0 for any that is free"
            ) from None
        reason = getattr(error, "strerror", error)
        raise InputError(f"cannot listen on {host}, port {port}: {reason}") from None


def serve(answers: Answers, host: str, port: int, browser: bool, debug: bool) -> None:
    """Say the address, open it in the browser if wanted, and answer until a signal ends it (KeyboardInterrupt).

    debug: let the terminal say where what was not expected has happened.
    """
    logging.disable(logging.NOTSET if debug else logging.CRITICAL)
    server = Server(answers, host, port)
    say(f"The designer's page: {server.address} (Ctrl-C ends it)")
    if not server.private:
        complain(f"everybody who can connect to {host} and knows this address may use the page")
    if browser:
        threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
    server.run()
