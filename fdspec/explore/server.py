"""The server of the page, for one person on one machine."""

from __future__ import annotations

import asyncio
import ipaddress
import tempfile
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, Final

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, RequestHandler

from fdspec import store
from fdspec.errors import FdspecError, InvalidInput, StoreError
from fdspec.explore.best import packed_best
from fdspec.explore.content import Content
from fdspec.explore.page import plotly_script, served_page
from fdspec.explore.rerun import Rerun

POLICY: Final = (
    "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'"
)
"""Content security policy: the page talks to its own server and to nobody else."""

LOOPBACK_NAMES: Final = r"(localhost|127\.\d+\.\d+\.\d+|\[::1\])"
"""Names under which a server on loopback answers: a stranger's page whose name points here gets 404."""


def serve(
    content: Content, rerun: Rerun, *, host: str = "127.0.0.1", port: int = 0, ready: Callable[[str], None]
) -> None:
    """Serve the page until this is interrupted.

    Parameters
    ----------
    content, rerun
        What the page shows, and who runs its histories.
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


async def _serve(content: Content, rerun: Rerun, host: str, port: int, ready: Callable[[str], None]) -> None:
    try:
        sockets = bind_sockets(port, host)
    except OSError as error:
        raise StoreError(
            f"cannot listen on {host} port {port}: {error.strerror or error}; give another with --port"
        ) from error
    server = HTTPServer(application(content, rerun, host))
    server.add_sockets(sockets)
    bound = sockets[0].getsockname()[1]
    ready(f"http://{f'[{host}]' if ':' in host else host}:{bound}/")
    # The kernels come from their cache while the reader looks at the page.
    asyncio.get_running_loop().run_in_executor(None, _warm)
    await asyncio.Event().wait()


def _warm() -> None:
    for name in (
        "fdspec.engines.single_storey",
        "fdspec.choice",
        "fdspec.engines.batch",
        "fdspec.engines.strain",
    ):
        import_module(name)


def application(content: Content, rerun: Rerun, host: str) -> Application:
    """Return the pages that the server answers."""
    page = served_page(content).encode()
    routes: list[Any] = [
        (r"/", _Text, {"body": page, "kind": "text/html; charset=utf-8"}),
        (
            r"/plotly\.js",
            _Text,
            {"body": plotly_script().encode(), "kind": "text/javascript; charset=utf-8", "keep": True},
        ),
        (r"/record/(\d+)", _Record, {"content": content}),
        (r"/history", _History, {"rerun": rerun}),
        (r"/history\.nc", _HistoryFile, {"rerun": rerun}),
        (r"/best", _Best, {"rerun": rerun}),
    ]
    names = LOOPBACK_NAMES if is_loopback(host) else r".*"
    found = Application(log_function=lambda _: None)
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

    def refuse(self, error: FdspecError) -> None:
        """Answer with the sentence that the page shows."""
        self.set_status(422)
        self.finish({"error": str(error)})


class _Text(_Answer):
    def initialize(self, body: bytes, kind: str, keep: bool = False) -> None:
        self.body, self.kind, self.keep = body, kind, keep

    def get(self) -> None:
        self.set_header("Content-Type", self.kind)
        if self.keep:
            self.set_header("Cache-Control", "no-cache")
        self.finish(self.body)


class _Record(_Answer):
    def initialize(self, content: Content) -> None:
        self.content = content

    async def get(self, position: str) -> None:
        if int(position) >= len(self.content.records):
            self.refuse(InvalidInput(f"the cube has {len(self.content.records)} records, not {position}"))
            return
        body = await asyncio.to_thread(self.content.record, int(position))
        self.set_header("Content-Type", "application/octet-stream")
        self.finish(body)


class _Computed(_Answer):
    """An answer that runs the engine, in a thread of its own."""

    kind = "application/octet-stream"

    def initialize(self, rerun: Rerun) -> None:
        self.rerun = rerun

    async def get(self) -> None:
        try:
            body = await asyncio.to_thread(self.computed)
        except FdspecError as error:
            self.refuse(error)
            return
        self.set_header("Content-Type", self.kind)
        self.finish(body)

    def computed(self) -> bytes:
        """Return the body of the answer."""
        raise NotImplementedError

    def position(self, name: str) -> int:
        """Return a position in the cube that the address names."""
        text = self.get_query_argument(name, "")
        if not (text.isascii() and text.isdecimal()):
            raise InvalidInput(f"{name} must be a position in the cube, got {text!r}")
        return int(text)

    def place(self) -> tuple[int, int, int, int]:
        """Return the positions of the cell that the address names."""
        record, ratio, force, period = (
            self.position(name) for name in ("record", "stiffness_ratio", "pretension", "period")
        )
        return record, ratio, force, period


class _History(_Computed):
    def computed(self) -> bytes:
        return self.rerun.packed(*self.place())


class _Best(_Computed):
    def computed(self) -> bytes:
        period = self.position("period") if self.get_query_argument("period", "") else None
        return packed_best(
            self.rerun,
            self.position("record"),
            self.position("stiffness_ratio"),
            self.get_query_argument("index", ""),
            period,
        )


class _HistoryFile(_Computed):
    kind = "application/x-netcdf"

    def computed(self) -> bytes:
        """Return the history as the bytes of the file that `fdspec.save` writes."""
        history, _ = self.rerun.history(*self.place())
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "history.nc"
            store.save(history, path)
            return path.read_bytes()
