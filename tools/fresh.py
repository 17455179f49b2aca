"""Proves both commands of the README from nothing, in bare roots of Debian: `make fresh`.

Each root is made by debootstrap, with no more than git, make, curl and Python. In it, a clone of
what is committed is served by `make run`, all that the README shows is tried, and `make test`
passes. Wants root, debootstrap and some 6 GB for each root:
fresh.py [--folder FOLDER] [--only run|test] [SUITE …]
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
SUITES = ("bookworm", "trixie")
"""Debian 12 with Python 3.11, and Debian 13 with Python 3.13."""

PACKAGES = "ca-certificates,curl,git,make,python3,python3-venv"
PORT = 8000

CERTIFICATES = "/etc/ssl/certs/ca-certificates.crt"
TRUSTED = ("PIP_CERT", "SSL_CERT_FILE", "NODE_EXTRA_CA_CERTS")
"""Whom to trust is told to pip, Python and Node: this machine may have other certificates."""

MOUNTS = 'mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && exec chroot "$0" "$@"'

AS_NOBODY_SPECIAL = """
useradd --create-home newcomer
said=$(su newcomer -c tools/system-packages.sh 2>&1)
echo "$said"
[[ "$said" == *"sudo apt-get install "*libgl1* ]]
"""

RUN = f"""
make run PORT={PORT} > /root/run.log 2>&1 &
service=$!
trap 'kill $service; wait $service || true' EXIT
until curl --silent --fail --output /dev/null http://127.0.0.1:{PORT}/readyz; do
  sleep 1
  kill -0 $service 2>/dev/null || {{ tail -n 40 /root/run.log; exit 1; }}
done
"""

README = f"""
.venv/bin/tubeloom serve --port {PORT} > /root/serve.log 2>&1 &
service=$!
trap 'kill $service; wait $service || true' EXIT
until curl --silent --fail --output /dev/null http://127.0.0.1:{PORT}/readyz; do
  sleep 1
  kill -0 $service 2>/dev/null || {{ tail -n 40 /root/serve.log; exit 1; }}
done
.venv/bin/python tools/readme.py http://127.0.0.1:{PORT}
"""

STEPS = (
    ("as another user", "run", AS_NOBODY_SPECIAL),
    ("make run", "run", RUN),
    ("the README and all examples", "run", README),
    ("make test", "test", "CI=true make test > /root/test.log 2>&1; tail -n 40 /root/test.log"),
)


def main(arguments: Sequence[str]) -> None:
    """Make each root anew, carry out the steps in it, and say how long each took."""
    parser = argparse.ArgumentParser(description="Proves the commands of the README from nothing.")
    parser.add_argument("suites", nargs="*", default=SUITES, help="releases of Debian")
    parser.add_argument("--folder", type=Path, help="where roots are made; else in a temporary one")
    parser.add_argument("--only", choices=("run", "test"), help="try only this command")
    options = parser.parse_args(arguments)
    if os.geteuid() != 0:
        sys.exit("Only root may make a root of Debian: sudo make fresh")
    if shutil.which("debootstrap") is None:
        sys.exit("Please run: apt-get install debootstrap")
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.folder or Path(temporary)).resolve()
        for suite in options.suites:
            prove(suite, folder / suite, options.only)


def prove(suite: str, root: Path, only: str | None) -> None:
    """Make a root and carry out the steps in it. Ends the process where one fails."""
    shutil.rmtree(root, ignore_errors=True)
    root.mkdir(parents=True)
    command = ["debootstrap", "--variant=minbase", f"--include={PACKAGES}", suite, str(root)]
    timed(f"{suite}: debootstrap", command, quiet=True)
    timed(f"{suite}: git clone", ["git", "clone", "--quiet", str(REPOSITORY), f"{root}/tubeloom"])
    shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
    shutil.copy(CERTIFICATES, root / CERTIFICATES.lstrip("/"))
    for name, part, script in STEPS:
        if only in {None, part}:
            timed(f"{suite}: {name}", inside(root, script))


def inside(root: Path, script: str) -> list[str]:
    """A command that runs ``script`` in ``root``; whatever it leaves running ends with it."""
    environment = {
        "HOME": "/root",
        "LANG": "C.UTF-8",
        "PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
        **dict.fromkeys(TRUSTED, CERTIFICATES),
    }
    return [
        *("unshare", "--mount", "--propagation", "private", "--pid", "--fork", "--kill-child"),
        *("sh", "-c", MOUNTS, str(root), "/usr/bin/env", "--ignore-environment"),
        *(f"{name}={value}" for name, value in environment.items()),
        *("bash", "-euo", "pipefail", "-c", f"cd /tubeloom\n{script}"),
    ]


def timed(name: str, command: list[str], *, quiet: bool = False) -> None:
    """Run a command and say how long it took. Ends the process where it fails."""
    start = time.monotonic()
    output = subprocess.PIPE if quiet else None
    done = subprocess.run(command, stdout=output, stderr=output, check=False)
    took = time.monotonic() - start
    sys.stdout.write(f"{took:7.1f} s  {name}{': FAILED' if done.returncode else ''}\n")
    sys.stdout.flush()
    if done.returncode:
        sys.exit((done.stdout or b"").decode(errors="replace")[-4000:] or 1)


if __name__ == "__main__":
    main(sys.argv[1:])
