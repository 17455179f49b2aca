"""Memory that runs out in libraries: in a process of its own, which may take little more."""

from __future__ import annotations

import subprocess
import sys

import pytest

LIMITED = """
import resource
import threading

import numpy as np
from PIL import Image

from app.answers import RenderOptions
from app.jobs.shortage import shortage
from app.output.memory_needs import held_bytes, require
from app.settings import Settings

MIB = 1 << 20
resource.setrlimit(resource.RLIMIT_DATA, 2 * (held_bytes() + 64 * MIB,))

def threads():
    wait = threading.Event()
    try:
        for _ in range(1000):
            threading.Thread(target=wait.wait, daemon=True).start()
    finally:
        wait.set()

try:
    {does}
except BaseException as error:
    print(type(error).__name__, error)
    found = shortage(error, RenderOptions(), Settings())
    assert found is not None, repr(error)
    assert "TUBELOOM_MAX_WORKER_BYTES" in str(found)
else:
    raise AssertionError("There was enough.")
"""

DOES = (
    "bytearray(1 << 30)",
    "np.zeros((1 << 30,))",
    "Image.new('RGBA', (30_000, 30_000))",
    "threads()",
    "require(256 * MIB)",
)


@pytest.mark.parametrize("does", DOES)
def test_memory_that_runs_out_is_known_whatever_says_so(does: str) -> None:
    program = LIMITED.replace("{does}", does)
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
