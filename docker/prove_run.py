"""Runs what has been built as Docker would, and checks that it serves. Has a network of its own."""

from __future__ import annotations

import fcntl
import json
import re
import signal
import socket
import struct
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

from prove_build import REPOSITORY, overlay
from steps import Stage, stages

URL = "http://127.0.0.1:8000"
SCRATCH_BYTES = 512 * 1024**2
WITHIN_SECONDS = 120.0
PAGES = ("/", "/viewer", "/editor", "/litegraph")
EXAMPLE = REPOSITORY / "examples" / "id3-clause-2.json"


def main() -> None:
    """Start it twice, the second time over what the first has stored."""
    folder = Path(sys.argv[1])
    raise_loopback()
    stage = stages()[-1]
    root = mounted(stage, folder)
    check_locked(stage, root)
    service = start(stage, root, folder / "service.log")
    words = ["tubeloom", "keys", "create", "proof", "--scope", "admin"]
    key = inside(stage, root, words, text=True).stdout.strip()
    check_pages()
    check_answers(key)
    stored = check_stored(key)
    assert inside(stage, root, stage.healthcheck).returncode == 0, "HEALTHCHECK fails"
    print(f"{'':10}HEALTHCHECK succeeds; memory {memory(root) / 1e6:.0f} MB in all")
    stop(service)
    service = start(stage, root, folder / "service.log")
    assert call(key, "/v1/programs/proof") == stored, "what was stored is not there any more"
    print(f"{'':10}what was stored is there after a restart")
    stop(service)


def mounted(stage: Stage, folder: Path) -> Path:
    """The image's root, read-only, with its volumes and a scratch folder."""
    root = folder / "root"
    root.mkdir(exist_ok=True)
    overlay(root, [Path(line) for line in (folder / "layers").read_text().splitlines()])
    mount("-t", "proc", "proc", f"{root}/proc")
    mount("-t", "tmpfs", "-o", "mode=755,size=64k", "dev", f"{root}/dev")
    for name in ("null", "zero", "full", "random", "urandom"):
        (root / "dev" / name).touch()
        mount("--bind", f"/dev/{name}", f"{root}/dev/{name}")
    (root / "dev/shm").mkdir()
    mount("-t", "tmpfs", "-o", "mode=1777,size=64m", "shm", f"{root}/dev/shm")
    mount("-t", "tmpfs", "-o", f"mode=1777,size={SCRATCH_BYTES}", "tmp", f"{root}/tmp")
    for number, volume in enumerate(stage.volumes):
        within = root / volume.lstrip("/")
        place = folder / f"volume-{number}"
        subprocess.run(["rm", "-rf", str(place)], check=True)
        subprocess.run(["cp", "-a", str(within), str(place)], check=True)  # as Docker begins one
        mount("--bind", str(place), str(within))
    return root


def check_locked(stage: Stage, root: Path) -> None:
    """The user is not root, has no rights of its own, and can write where it should alone."""
    for place, may in (("/", 0), ("/venv", 0), ("/etc", 0), ("/tmp", 1), (stage.volumes[0], 1)):
        wrote = inside(stage, root, ["sh", "-c", f"touch {place}/x && rm {place}/x"])
        assert (wrote.returncode == 0) == bool(may), (place, wrote.stderr)
    status = inside(stage, root, ["grep", "-E", "^(Uid|CapEff|NoNewPrivs)", "/proc/self/status"])
    print(f"{'':10}{' '.join(status.stdout.decode().split())}; only /tmp and the volume writable")


def start(stage: Stage, root: Path, log: Path) -> subprocess.Popen[bytes]:
    """Start the service; it is ready at the end."""
    began = time.monotonic()
    service = subprocess.Popen(
        command(stage, root, stage.entrypoint + stage.command), stderr=log.open("ab")
    )
    until("/healthz answers", began, lambda: call(None, "/healthz"))
    ready = until("/readyz says ready", began, lambda: call(None, "/readyz"))
    assert json.loads(ready)["status"] == "ready", ready
    return service


def stop(service: subprocess.Popen[bytes]) -> None:
    """End it as Docker does."""
    service.terminate()
    assert service.wait(10) in {0, -signal.SIGTERM}, service.returncode


def check_pages() -> None:
    """Browsers get the pages, and all that these load, without a key."""
    for page in PAGES:
        text = call(None, page).decode()
        parts = set(re.findall(r"(?:src|href)=\"(/[^\"]+)\"", text))
        sizes = [len(call(None, part)) for part in parts]
        assert sizes, f"{page} loads nothing"
        print(f"{'':10}{page} loads {len(sizes)} files of {sum(sizes):,} bytes")


def check_answers(key: str) -> None:
    """Without a key nothing; with one, scenes, pictures and numbers."""
    document = EXAMPLE.read_bytes()
    try:
        call(None, "/v1/layout", document)
        raise AssertionError("answers without a key")
    except urllib.error.HTTPError as refusal:
        if refusal.code != 401:
            raise
    for ask, begins in (
        ("/v1/layout", b'{"items"'),
        ("/v1/render?format=glb", b"glTF"),
        ("/v1/render?format=png", b"\x89PNG"),
        ("/v1/render?format=png&quality=final&width=320&height=240&samples=16", b"\x89PNG"),
        ("/v1/render?format=svg", b"<svg"),
    ):
        began = time.monotonic()
        answer = call(key, ask, document)
        assert answer.startswith(begins), answer[:200]
        print(f"{time.monotonic() - began:7.2f} s  {len(answer):9,} bytes  {ask}")


def check_stored(key: str) -> bytes:
    """Store a program, edit it and draw it; its document."""
    call(key, "/v1/programs/proof", EXAMPLE.read_bytes(), "PUT")
    edit = {"edits": [{"type": "add_item", "item": {"id": "proof", "label": "Proof"}}]}
    changed = json.loads(call(key, "/v1/programs/proof/edits", json.dumps(edit).encode()))
    assert changed["changes"]["items"]["added"] == ["proof"], changed
    began = time.monotonic()
    assert call(key, "/v1/programs/proof/render?format=png").startswith(b"\x89PNG")
    print(f"{time.monotonic() - began:7.2f} s  a stored program, edited, as PNG")
    return call(key, "/v1/programs/proof")


def call(key: str | None, path: str, body: bytes | None = None, method: str | None = None) -> bytes:
    """The answer's body. Raises `urllib.error.URLError`."""
    headers = {"Content-Type": "application/json"}
    if key is not None:
        headers["Authorization"] = f"Bearer {key}"
    request = urllib.request.Request(URL + path, body, headers, method=method)
    with urllib.request.urlopen(request, timeout=WITHIN_SECONDS) as response:
        content: bytes = response.read()
        return content


def until(what: str, began: float, ask: Callable[[], bytes]) -> bytes:
    """The answer, as soon as there is one."""
    while True:
        try:
            answer = ask()
        except urllib.error.URLError:
            if time.monotonic() - began > WITHIN_SECONDS:
                raise
            time.sleep(0.05)
            continue
        print(f"{time.monotonic() - began:7.2f} s  {what}")
        return answer


def command(stage: Stage, root: Path, words: list[str]) -> list[str]:
    """What runs ``words`` within ``root``, as the image's user with the image's environment."""
    environment = [f"{name}={value}" for name, value in stage.environment.items()]
    rights = f"--reuid={stage.user} --regid={stage.user} --clear-groups --no-new-privs"
    return [
        *("chroot", str(root), "env", "--ignore-environment", "PATH=/usr/sbin:/usr/bin"),
        *("setpriv", *rights.split(), "--bounding-set=-all", "--inh-caps=-all"),
        *("env", f"--chdir={stage.folder}", *environment, *words),
    ]


def inside(
    stage: Stage, root: Path, words: list[str], **options: Any
) -> subprocess.CompletedProcess[Any]:
    """Run a command besides, as ``docker exec`` does."""
    return subprocess.run(command(stage, root, words), capture_output=True, check=False, **options)


def memory(root: Path) -> int:
    """Bytes of memory that the service's processes hold; shared ones in parts."""
    found = 0
    for process in Path("/proc").iterdir():
        try:
            if (process / "root").readlink() == root:
                rollup = (process / "smaps_rollup").read_text()
                found += int(rollup.split("Pss:")[1].split()[0]) * 1024
        except (OSError, IndexError):
            continue
    return found


def mount(*words: str) -> None:
    """Mount something."""
    subprocess.run(["mount", *words], check=True)


def raise_loopback() -> None:
    """A new network has a loopback that is down."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as door:
        fcntl.ioctl(door, 0x8914, struct.pack("16sh", b"lo", 1))  # SIOCSIFFLAGS, IFF_UP


if __name__ == "__main__":
    main()
