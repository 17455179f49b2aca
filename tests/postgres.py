"""A real PostgreSQL of its own, for tests that want one."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.children import SCRIPT_SECONDS
from tests.conftest import require
from tests.service import PATIENCE_SECONDS, until


def _programs() -> Path | None:
    """Where Debian keeps the newest version's programs."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin"), key=lambda path: int(path.parts[-2]))
    return found[-1] if found else None


@dataclass
class Postgres:
    """A server on a port of its own, which can be killed and started again."""

    programs: Path
    folder: Path
    port: int
    process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        """As the settings want it."""
        return f"postgresql://tubeloom@127.0.0.1:{self.port}/postgres"

    def start(self) -> None:
        """Start it, and wait until it answers."""
        with (self.folder / "log").open("ab") as log:
            self.process = subprocess.Popen(
                [
                    *_as_nobody_special(),
                    *(str(self.programs / "postgres"), "-D", str(self.folder / "data")),
                    *("-p", str(self.port), "-c", "listen_addresses=127.0.0.1"),
                    *("-c", "unix_socket_directories=", "-c", "max_connections=50"),
                ],
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        until(self._answers)

    def kill(self) -> None:
        """``kill -9`` of every process of it."""
        assert self.process is not None
        pids = self.folder / "data" / "postmaster.pid"
        main = int(pids.read_text().split()[0])
        os.killpg(os.getpgid(main), signal.SIGKILL)
        self.process.wait(PATIENCE_SECONDS)
        until(lambda: not self._answers())
        pids.unlink(missing_ok=True)

    def stop(self) -> None:
        """Stop it, however it is."""
        if self.process is not None and self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGINT)
            self.process.wait(PATIENCE_SECONDS)

    def _answers(self) -> bool:
        ready = subprocess.run(
            [str(self.programs / "pg_isready"), "-q", "-h", "127.0.0.1", "-p", str(self.port)],
            check=False,
            timeout=PATIENCE_SECONDS,
        )
        return ready.returncode == 0


@contextmanager
def running_postgres() -> Iterator[Postgres]:
    """A server with an empty database, gone afterwards."""
    programs = _programs()
    require(programs, "PostgreSQL is not installed: apt-get install postgresql")
    assert programs is not None
    folder = Path(tempfile.mkdtemp(prefix="tubeloom-postgres-"))
    if os.geteuid() == 0:
        shutil.chown(folder, "postgres", "postgres")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    subprocess.run(
        [
            *_as_nobody_special(),
            *(str(programs / "initdb"), "-D", str(folder / "data"), "-U", "tubeloom"),
            *("--auth=trust", "--no-sync", "--encoding=UTF8", "--locale=C"),
        ],
        check=True,
        stdout=subprocess.DEVNULL,
        cwd="/",
        timeout=SCRIPT_SECONDS,
    )
    server = Postgres(programs, folder, port)
    try:
        server.start()
        yield server
    finally:
        server.stop()
        shutil.rmtree(folder, ignore_errors=True)


def _as_nobody_special() -> list[str]:
    """PostgreSQL does not run as root."""
    return ["setpriv", "--reuid=postgres", "--regid=postgres", "--init-groups"] * (
        os.geteuid() == 0
    )
