"""`fdspec explore` as a process: where it listens, what it answers, how it ends."""

import http.client
import json
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from fdspec import store
from tests.explored import own_motion, record_numbers, small_cube, unpack


@pytest.fixture(scope="module")
def port(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    """Serve a cube whose second record is no catalogue's; give the port, and see the process end well."""
    path = tmp_path_factory.mktemp("explore") / "cube.nc"
    cube = small_cube(own_motion("FSR1"), own_motion("mine"))
    store.save(cube, path)
    command = [sys.executable, "-m", "fdspec", "explore", str(path), "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        address = process.stdout.readline().split()[0]
        assert address.startswith("http://127.0.0.1:")
        yield int(address.rstrip("/").rpartition(":")[2])
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=20)
        assert err == ""
        assert process.returncode == 0
    finally:
        process.kill()
        process.communicate()


def answer(
    port: int, path: str, host: str | None = None, **headers: str
) -> tuple[int, http.client.HTTPMessage, bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("GET", path, headers={**({"Host": host} if host else {}), **headers})
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response.status, response.headers, body


PLACE = "stiffness_ratio=1&pretension=2&period=2"


def test_it_answers_with_the_page_and_the_records(port: int) -> None:
    status, headers, body = answer(port, "/")
    assert status == 200
    assert headers["Content-Type"] == "text/html; charset=utf-8"
    assert b"<h1" in body
    assert headers["Content-Security-Policy"].startswith("default-src 'self' ")
    status, _, body = answer(port, "/record/1")
    assert status == 200
    assert record_numbers(body)["acceleration"].size == 90
    assert answer(port, "/record/2")[0] == 422
    assert answer(port, "/../pyproject.toml")[0] == 404


def test_a_history_of_another_motion_is_run_and_said(port: int) -> None:
    status, _, body = answer(port, f"/history?record=0&{PLACE}")
    assert status == 200
    about, arrays = unpack(body)
    assert "its checksum is" in about["notice"]
    assert arrays["time"].size > 100


@pytest.mark.parametrize("path", ["/history", "/history.nc"])
def test_what_cannot_be_run_is_one_sentence(port: int, path: str) -> None:
    for query, sentence in {
        f"record=1&{PLACE}": "record 'mine' is not in the catalogue",
        f"record=9&{PLACE}": "record must be a position from 0 to 1, got 9",
        f"record=-1&{PLACE}": "record must be a position in the cube, got '-1'",
        "record=0": "stiffness_ratio must be a position in the cube, got ''",
    }.items():
        status, headers, body = answer(port, f"{path}?{query}")
        assert status == 422
        assert headers["Content-Type"].startswith("application/json")
        assert sentence in json.loads(body)["error"]


def test_a_history_as_a_file(port: int, tmp_path: Path) -> None:
    status, _, body = answer(port, f"/history.nc?record=0&{PLACE}")
    assert status == 200
    (tmp_path / "history.nc").write_bytes(body)
    assert float(store.open(tmp_path / "history.nc")["peak_acceleration"][0]) > 0.0


def test_a_strangers_name_for_this_machine_is_not_answered(port: int) -> None:
    assert answer(port, "/", host="evil.example")[0] == 404
    assert answer(port, f"/history?record=0&{PLACE}", host="127.0.0.1.evil.example")[0] == 404
    assert answer(port, "/", host=f"localhost:{port}")[0] == 200


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have one loopback address")
def test_it_listens_on_one_address_alone(port: int) -> None:
    other = http.client.HTTPConnection("127.0.0.2", port, timeout=5)
    with pytest.raises(ConnectionRefusedError):
        other.connect()


def test_a_port_that_is_taken_is_told(port: int, tmp_path: Path) -> None:
    store.save(small_cube(own_motion("mine")), tmp_path / "cube.nc")
    command = [sys.executable, "-m", "fdspec", "explore", str(tmp_path / "cube.nc"), "--port", str(port)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert f"cannot listen on 127.0.0.1 port {port}: " in done.stderr
    assert done.stderr.rstrip().endswith("give another with --port")


@pytest.mark.parametrize(
    "path", ["/record/{0}", "/history?record={0}&" + PLACE, "/best?record={0}&index=R_A"]
)
def test_a_silly_position_is_a_bad_request(port: int, path: str) -> None:
    assert answer(port, path.format("9" * 5000))[0] == 400
    assert answer(port, path.format("9" * 10))[0] == 400


@pytest.mark.parametrize(
    "headers",
    [
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},  # another server of this machine
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
    ],
)
@pytest.mark.parametrize("path", ["/history", "/history.nc", "/best", "/record/0"])
def test_another_site_starts_no_work(port: int, path: str, headers: dict[str, str]) -> None:
    assert answer(port, f"{path}?record=0&{PLACE}", **headers)[0] == 403


def test_the_page_itself_may_be_linked_and_asks_for_its_own(port: int) -> None:
    assert answer(port, "/", **{"Sec-Fetch-Site": "cross-site"})[0] == 200
    own = {"Sec-Fetch-Site": "same-origin", "Origin": f"http://127.0.0.1:{port}"}
    assert answer(port, f"/history?record=0&{PLACE}", **own)[0] == 200


def slow_server(tmp_path: Path, hold: str) -> tuple[subprocess.Popen[str], int]:
    """Serve a cube whose every history takes as long as this file exists and adds a line to it at first."""
    store.save(small_cube(own_motion("FSR1"), own_motion("mine")), tmp_path / "cube.nc")
    code = f"""
import sys, time
from pathlib import Path
import fdspec.explore.rerun as rerun
def packed(self, *place):
    hold = Path({hold!r})
    with hold.open("a") as file:
        file.write("begun\\n")
    while hold.exists():
        time.sleep(0.02)
    return b""
rerun.Rerun.packed = packed
from fdspec.cli import run
sys.argv = ["fdspec", "explore", {str(tmp_path / "cube.nc")!r}, "--no-browser"]
run()
"""
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    return process, int(process.stdout.readline().split()[0].rstrip("/").rpartition(":")[2])


def asking(port: int) -> socket.socket:
    """Ask for a history; the answer is read where it is wanted."""
    client = socket.create_connection(("127.0.0.1", port))
    client.sendall(f"GET /history?record=0&{PLACE} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
    return client


def test_work_is_bounded_stops_with_its_client_and_with_one_ctrl_c(tmp_path: Path) -> None:
    hold = tmp_path / "hold"
    hold.touch()
    process, port = slow_server(tmp_path, str(hold))
    clients: list[socket.socket] = []
    try:
        clients += [asking(port) for _ in range(20)]
        refused = 0
        for client in clients:
            client.settimeout(0.2)
            with suppress(TimeoutError):
                refused += client.recv(100).startswith(b"HTTP/1.1 503")
        assert refused >= 9
        assert hold.read_text() == "begun\n" * 2
        assert answer(port, "/")[0] == 200  # the page itself waits for nobody
        for client in clients:
            client.close()
        time.sleep(0.5)
        hold.unlink()
        time.sleep(0.5)
        assert not hold.exists()  # nothing of those that had waited began
        hold.touch()
        clients = [asking(port)]
        while not hold.read_text():
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=10)
        assert (process.returncode, err) == (0, "")
    finally:
        for client in clients:
            client.close()
        process.kill()
        process.communicate()
