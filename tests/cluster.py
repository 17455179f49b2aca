"""A real Dask cluster of processes on this machine, each of which can be killed."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import psutil

from tests.service import PATIENCE_SECONDS, until

_SCHEDULER = "distributed.cli.dask_scheduler"
_WORKER = "distributed.cli.dask_worker"


@dataclass
class Cluster:
    """A scheduler and workers of one thread; what ends is started again, as a supervisor does."""

    folder: Path
    port: int
    cores: tuple[frozenset[int] | None, ...]
    scheduler: subprocess.Popen[bytes] | None = None
    workers: list[subprocess.Popen[bytes] | None] = field(default_factory=list)
    _ending: threading.Event = field(default_factory=threading.Event)
    _watching: threading.Thread | None = None

    @property
    def address(self) -> str:
        """As the settings want it."""
        return f"tcp://127.0.0.1:{self.port}"

    def start(self) -> None:
        """Start all of it, and wait until the scheduler answers."""
        self.workers = [None] * len(self.cores)
        self._watching = threading.Thread(target=self._watch, daemon=True)
        self._watching.start()
        until(self._answers)

    def kill_worker(self, number: int) -> None:
        """``kill -9`` of a worker."""
        worker = self.workers[number]
        assert worker is not None
        worker.send_signal(signal.SIGKILL)

    def kill_scheduler(self) -> None:
        """``kill -9`` of the scheduler."""
        assert self.scheduler is not None
        self.scheduler.send_signal(signal.SIGKILL)

    def children(self) -> list[psutil.Process]:
        """The processes that do the workers' work."""
        found = []
        for worker in self.workers:
            if worker is not None and worker.poll() is None:
                found += psutil.Process(worker.pid).children()
        return [each for each in found if each.status() != psutil.STATUS_ZOMBIE]

    def stop(self) -> None:
        """Stop all of it."""
        self._ending.set()
        if self._watching is not None:
            self._watching.join(PATIENCE_SECONDS)
        for process in (*self.workers, self.scheduler):
            if process is not None:
                process.kill()
                process.wait(PATIENCE_SECONDS)

    def log(self) -> str:
        """What all have said."""
        return (self.folder / "cluster.log").read_text()

    def _watch(self) -> None:
        while not self._ending.wait(0.2):
            if self.scheduler is None or self.scheduler.poll() is not None:
                address = ("--host", "127.0.0.1", "--port", str(self.port))
                self.scheduler = self._run(None, _SCHEDULER, *address, "--no-dashboard")
            for number, worker in enumerate(self.workers):
                if worker is None or worker.poll() is not None:
                    self.workers[number] = self._run(
                        self.cores[number],
                        *(_WORKER, self.address, "--no-dashboard", "--no-nanny"),
                        *("--nthreads", "1", "--local-directory", str(self.folder)),
                    )

    def _run(self, cores: frozenset[int] | None, *command: str) -> subprocess.Popen[bytes]:
        with (self.folder / "cluster.log").open("ab") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", *command], stdout=log, stderr=log, env=os.environ
            )
        if cores is not None:
            os.sched_setaffinity(process.pid, cores)
        return process

    def _answers(self) -> bool:
        with socket.socket() as door:
            return door.connect_ex(("127.0.0.1", self.port)) == 0


@contextmanager
def running_cluster(
    folder: Path, workers: int = 2, cores: tuple[frozenset[int], ...] | None = None
) -> Iterator[Cluster]:
    """A cluster, each of whose workers may be bound to ``cores``; gone afterwards."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    folder.mkdir(parents=True, exist_ok=True)
    cluster = Cluster(folder, port, cores or (None,) * workers)
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()
