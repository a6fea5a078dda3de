"""The server of the page, for one person on one machine."""

from __future__ import annotations

import asyncio
import ipaddress
import tempfile
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any, Final

from tornado.httpserver import HTTPServer
from tornado.iostream import StreamClosedError
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler

from fdspec import store
from fdspec.errors import FdspecError, InvalidInput, StoreError
from fdspec.explore.beside import Reruns
from fdspec.explore.best import packed_best
from fdspec.explore.page import Shown, plotly_script, served_page
from fdspec.explore.point import FIELDS, packed_point, point_of
from fdspec.explore.rerun import Rerun

POLICY: Final = (
    "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'"
)
"""Content security policy: the page talks to its own server and to nobody else."""

AT_ONCE: Final = 2
"""Answers that are computed at a time; a reader waits for one."""

WAITING: Final = 8
"""Answers that may wait for their turn; more are refused, and the page asks again at the next click."""

DIGITS: Final = 9
"""Of a position at most: Python itself refuses to read numbers of some thousands."""

LOOPBACK_NAMES: Final = r"(localhost|127\.\d+\.\d+\.\d+|\[::1\])"
"""Names under which a server on loopback answers: a stranger's page whose name points here gets 404."""


def serve(
    content: Shown,
    rerun: Rerun | Reruns | None,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    ready: Callable[[str], None],
) -> None:
    """Serve the page until this is interrupted.

    Parameters
    ----------
    content, rerun
        What the page shows, and who runs its histories; None where nobody does.
    host : str
        Address to bind to. On loopback, requests under other names are refused.
    port : int
        0 takes a free one.
    ready : callable
        Called once with the address of the page, when it can be opened.

    Raises
    ------
    StoreError
        When the address cannot be bound.
    """
    asyncio.run(_serve(content, rerun, host, port, ready))


async def _serve(
    content: Shown, rerun: Rerun | Reruns | None, host: str, port: int, ready: Callable[[str], None]
) -> None:
    try:
        sockets = bind_sockets(port, host)
    except OSError as error:
        raise StoreError(
            f"cannot listen on {host} port {port}: {error.strerror or error}; give another with --port"
        ) from error
    found = application(content, rerun, host)
    server = HTTPServer(found)
    server.add_sockets(sockets)
    bound = sockets[0].getsockname()[1]
    ready(f"http://{f'[{host}]' if ':' in host else host}:{bound}/")
    if rerun is not None:
        # The kernels come from their cache while the reader looks at the page.
        threading.Thread(target=_warm, name="fdspec-page-warm", daemon=True).start()
    await asyncio.Event().wait()


def _warm() -> None:
    for name in (
        "fdspec.engines.single_storey",
        "fdspec.choice",
        "fdspec.engines.batch",
        "fdspec.engines.strain",
    ):
        import_module(name)


def application(content: Shown, rerun: Rerun | Reruns | None, host: str) -> Application:
    """Return the pages that the server answers."""
    page = served_page(content).encode()
    routes: list[Any] = [
        (r"/", _Text, {"body": page, "kind": "text/html; charset=utf-8"}),
        (
            r"/plotly\.js",
            _Text,
            {"body": plotly_script().encode(), "kind": "text/javascript; charset=utf-8", "keep": True},
        ),
        (r"/record/([0-9]+)", _Record, {"content": content}),
    ]
    if rerun is not None:
        routes += [
            (r"/history", _History, {"rerun": rerun}),
            (r"/history\.nc", _HistoryFile, {"rerun": rerun}),
            (r"/point", _Point, {"rerun": rerun}),
            (r"/best", _Best, {"rerun": rerun}),
        ]
    names = LOOPBACK_NAMES if is_loopback(host) else r".*"
    # Threads of this name do not hold the process when it is told to end: see fdspec.cli.main.
    bench = ThreadPoolExecutor(AT_ONCE, thread_name_prefix="fdspec-page")
    found = Application(log_function=lambda _: None, bench=bench)
    found.add_handlers(names, routes)
    return found


def is_loopback(host: str) -> bool:
    """Say whether only this machine can reach a server bound there."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


class _Answer(RequestHandler):
    def set_default_headers(self) -> None:
        self.set_header("Content-Security-Policy", POLICY)
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Cache-Control", "no-store")

    def prepare(self) -> None:
        """Refuse what another site's page asks for: it must not start work here, nor learn of it."""
        site = self.request.headers.get("Sec-Fetch-Site", "none")
        origin = self.request.headers.get("Origin", "")
        elsewhere = origin and origin.partition("://")[2] != self.request.host
        if self.own and (elsewhere or site not in {"none", "same-origin"}):
            raise HTTPError(403)

    own = True
    """Whether only this page may ask."""

    def refuse(self, error: FdspecError) -> None:
        """Answer with the sentence that the page shows."""
        self.set_status(422)
        self.finish({"error": str(error)})


class _Text(_Answer):
    own = False

    def initialize(self, body: bytes, kind: str, keep: bool = False) -> None:
        self.body, self.kind, self.keep = body, kind, keep

    def get(self) -> None:
        self.set_header("Content-Type", self.kind)
        if self.keep:
            self.set_header("Cache-Control", "no-cache")
        self.finish(self.body)


class _Record(_Answer):
    def initialize(self, content: Shown) -> None:
        self.content = content

    async def get(self, position: str) -> None:
        if len(position) > DIGITS:
            raise HTTPError(400)
        if int(position) >= len(self.content.records):
            self.refuse(InvalidInput(f"the cube has {len(self.content.records)} records, not {position}"))
            return
        try:
            body = await asyncio.to_thread(self.content.record, int(position))
        except FdspecError as error:  # a cube that is damaged, or was removed, since it was opened
            self.refuse(error)
            return
        self.set_header("Content-Type", "application/octet-stream")
        self.finish(body)


class _Computed(_Answer):
    """An answer that runs the engine, in a thread of its own."""

    kind = "application/octet-stream"

    def initialize(self, rerun: Rerun | Reruns) -> None:
        self.rerun = rerun

    async def get(self) -> None:
        bench: ThreadPoolExecutor = self.settings["bench"]
        if bench._work_queue.qsize() >= WAITING:  # noqa: SLF001 (it has no other name)
            self.set_status(503)
            self.finish({"error": "other histories are being computed; try again in a moment"})
            return
        self.at_work = bench.submit(self.computed)
        try:
            body = await asyncio.wrap_future(self.at_work)
        except FdspecError as error:
            self.refuse(error)
            return
        except asyncio.CancelledError:
            if self.gone:  # nobody waits for an answer
                return
            raise
        self.set_header("Content-Type", self.kind)
        with suppress(StreamClosedError):
            self.finish(body)

    at_work: Future[bytes] | None = None
    gone = False

    def on_connection_close(self) -> None:
        """Stop what the client no longer waits for."""
        self.gone = True
        if self.at_work is not None:
            self.at_work.cancel()

    def going_on(self, done: int, total: int) -> None:  # noqa: ARG002
        """Stop a search between its parts when the client has left."""
        if self.gone:
            raise InvalidInput("the client has left")

    def computed(self) -> bytes:
        """Return the body of the answer."""
        raise NotImplementedError

    def position(self, name: str) -> int:
        """Return a position in the cube that the address names."""
        text = self.get_query_argument(name, "")
        if not (text.isascii() and text.isdecimal()):
            raise InvalidInput(f"{name} must be a position in the cube, got {text!r:.60}")
        if len(text) > DIGITS:
            raise HTTPError(400)
        return int(text)

    def place(self) -> tuple[Rerun, int, int, int, int]:
        """Return who runs the history of the cell that the address names, and its positions."""
        rerun, record = self.rerun.of(self.position("record"))
        ratio, force, period = (self.position(name) for name in ("stiffness_ratio", "pretension", "period"))
        return rerun, record, ratio, force, period


class _History(_Computed):
    def computed(self) -> bytes:
        rerun, *place = self.place()
        return rerun.packed(*place)


class _Point(_Computed):
    def computed(self) -> bytes:
        given = {field.name: self.get_query_argument(field.name, "") for field in FIELDS}
        rerun, record = self.rerun.of(self.position("record"))
        return packed_point(rerun, record, point_of(given))


class _Best(_Computed):
    def computed(self) -> bytes:
        period = self.position("period") if self.get_query_argument("period", "") else None
        rerun, record = self.rerun.of(self.position("record"))
        return packed_best(
            rerun,
            record,
            self.position("stiffness_ratio"),
            self.get_query_argument("index", ""),
            period,
            self.going_on,
        )


class _HistoryFile(_Computed):
    kind = "application/x-netcdf"

    def computed(self) -> bytes:
        """Return the history as the bytes of the file that `fdspec.save` writes."""
        rerun, *place = self.place()
        history, _ = rerun.history(*place)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "history.nc"
            store.save(history, path)
            return path.read_bytes()
