"""Child processes that tests run, or talk with line by line; none is waited for without end.

What waits the shortest gives up first, and so says the most about what has hung: a step within a
script, a line or a test of it, the script, the test that runs it, and at last all of a process's
tests (`tool.pytest.ini_options` in ``pyproject.toml``).
"""

from __future__ import annotations

import subprocess
import threading
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from queue import Empty, Queue
from typing import Self

import pytest

from tests.service import PATIENCE_SECONDS

LINE_SECONDS = 2 * PATIENCE_SECONDS
"""For what a child says next, which may take it several steps."""

NODE_TEST_SECONDS = 420
"""For one test, or one file of tests, of node's own test runner."""

SCRIPT_SECONDS = 480.0
"""For a script of many steps, where it has a part of two busy processors."""


class Child:
    """A child process whose standard input and output are lines.

    Use it as a context manager, which ends it.
    """

    def __init__(
        self,
        command: Sequence[str],
        cwd: Path | None = None,
        env: Mapping[str, str] | None = None,
    ) -> None:
        self.process = subprocess.Popen(
            command,
            cwd=cwd,
            env=env,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._lines: Queue[str | None] = Queue()
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.wait(PATIENCE_SECONDS)
        self._reading.join(PATIENCE_SECONDS)
        for pipe in (self.process.stdin, self.process.stdout):
            assert pipe is not None
            pipe.close()

    def hear(self) -> str:
        """What it says next. Fails the test where that is nothing."""
        line = self._next()
        if line is None:
            pytest.fail(f"It has ended: {self.process.args!r}")
        return line

    def say(self, line: str) -> None:
        """Tell it something."""
        assert self.process.stdin is not None
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()

    def rest(self) -> list[str]:
        """All that it says until its end, which must be a good one; nobody tells it anything."""
        assert self.process.stdin is not None
        self.process.stdin.close()
        found = []
        while (line := self._next()) is not None:
            found.append(line)
        assert self.process.wait(PATIENCE_SECONDS) == 0
        return found

    def _next(self) -> str | None:
        try:
            return self._lines.get(timeout=LINE_SECONDS)
        except Empty:
            pytest.fail(f"It has said nothing for {LINE_SECONDS:g} s: {self.process.args!r}")

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._lines.put(line.rstrip("\n"))
        self._lines.put(None)


def run(
    command: Sequence[str], cwd: Path | None = None, env: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """What becomes of a command, in time."""
    return subprocess.run(
        command,
        cwd=cwd,
        env=env,
        capture_output=True,
        text=True,
        check=False,
        timeout=SCRIPT_SECONDS,
    )


def run_node_tests(script: str | Path, env: Mapping[str, str], cwd: Path | None = None) -> None:
    """Run a script of tests by node's own test runner; all must pass."""
    done = run(
        ["node", "--test", "--test-reporter=spec", *_limits(), str(script)], cwd=cwd, env=env
    )
    assert done.returncode == 0, done.stdout + done.stderr


@lru_cache(maxsize=1)
def _limits() -> tuple[str, ...]:
    """What limits the tests of a script, where this node can do that: since 20.11 it can."""
    name = "--test-timeout"
    return (f"{name}={1000 * NODE_TEST_SECONDS}",) if name in run(["node", "--help"]).stdout else ()
