"""Carries out the Dockerfile's steps in roots of its own: each stage a layer over its base."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import time
from pathlib import Path

from steps import Stage, Step, stages

REPOSITORY = Path(__file__).resolve().parent.parent
SUITE = "trixie"

UNSENT = ("__pycache__", "node_modules", "built")
"""What the builder is not sent, besides what `Dockerfile.dockerignore` leaves out anyway."""

CERTIFICATES = "/run/certificates"
"""Where steps find this machine's: at their usual place the steps may install others."""

BINDS = {
    "/etc/ssl/certs": CERTIFICATES,
    **{path: path for path in os.environ.get("PROVE_BINDS", "").split()},
}
"""Of this machine, read-only while steps run: what it needs to get at packages."""

TRUSTED = dict.fromkeys(
    ("SSL_CERT_FILE", "PIP_CERT", "NODE_EXTRA_CA_CERTS"), f"{CERTIFICATES}/ca-certificates.crt"
)
"""Whom Python, pip and Node trust while steps run."""


def main() -> None:
    """Build all stages in the folder that is named, and say how long and how large."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    debian = folder / "debian"
    if not (debian / "etc/os-release").exists():
        timed("debootstrap", ["debootstrap", "--variant=minbase", SUITE, str(debian)])
    roots: dict[str, Path] = {}
    layers = {f"debian:{SUITE}-slim": [debian]}
    for number, stage in enumerate(stages()):
        layers[stage.name] = build(stage, folder / f"{number}", layers, roots)
    print()
    for layer in layers[""]:
        print(f"{layer.relative_to(folder)!s:<18}{size(layer) / 1e6:7.0f} MB")
    print(f"{'image':<18}{sum(map(size, layers[''])) / 1e6:7.0f} MB")
    (folder / "layers").write_text("\n".join(map(str, layers[""])))


def build(
    stage: Stage, folder: Path, layers: dict[str, list[Path]], roots: dict[str, Path]
) -> list[Path]:
    """Carry out a stage's steps; the stage's layers, the lowest first."""
    shutil.rmtree(folder, ignore_errors=True)
    upper, work, root = folder / "layer", folder / "work", folder / "root"
    for path in (upper, work, root):
        path.mkdir(parents=True)
    roots[stage.name] = root
    below = layers[stage.base]
    overlay(root, below, upper, work)
    for step in stage.steps:
        if step.kind == "COPY":
            copy(step, root, roots)
        else:
            run(step, root)
    return [*below, upper]


def overlay(
    root: Path, below: list[Path], upper: Path | None = None, work: Path | None = None
) -> None:
    """Mount layers over each other; without an ``upper`` one, read-only."""
    options = f"lowerdir={':'.join(map(str, reversed(below)))}"
    if upper is not None:
        options += f",upperdir={upper},workdir={work}"
    subprocess.run(["mount", "-t", "overlay", "overlay", "-o", options, str(root)], check=True)


def copy(step: Step, root: Path, stages: dict[str, Path]) -> None:
    """Carry out a COPY, from the repository or from a stage."""
    words = shlex.split(step.text)
    flags = dict(word[2:].split("=", 1) for word in words if word.startswith("--"))
    *sources, target = [word for word in words if not word.startswith("--")]
    start = stages[flags["from"]] if "from" in flags else REPOSITORY
    into = root / (Path(step.folder) / target).relative_to("/")
    into.mkdir(parents=True, exist_ok=True) if target.endswith("/") else into.parent.mkdir(
        parents=True, exist_ok=True
    )
    for source in sources:
        found = start / source.lstrip("/")
        to = into / found.name if target.endswith("/") else into
        if found.is_dir():
            ignored = None if "from" in flags else shutil.ignore_patterns(*UNSENT)
            shutil.copytree(found, to, symlinks=True, ignore=ignored, dirs_exist_ok=True)
        else:
            shutil.copy2(found, to)
            if "chmod" in flags:
                to.chmod(int(flags["chmod"], 8))


def run(step: Step, root: Path) -> None:
    """Carry out a RUN as root within ``root``."""
    shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
    mounts = [["-t", "proc", "proc", f"{root}/proc"], ["--bind", "/dev", f"{root}/dev"]]
    made = []
    for path, place in BINDS.items():
        at = root / place.lstrip("/")
        made += [] if at.exists() else [at]
        at.mkdir(parents=True, exist_ok=True)
        mounts.append(["--bind", "-o", "ro", path, str(at)])
    for mount in mounts:
        subprocess.run(["mount", *mount], check=True)
    environment = {"PATH": os.defpath, "DEBIAN_FRONTEND": "noninteractive", **step.environment}
    environment |= {name: value for name, value in os.environ.items() if name.startswith("PIP_")}
    environment |= TRUSTED
    environment["PATH"] = step.environment.get(
        "PATH", "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
    )
    inside = f"mkdir -p {step.folder} && cd {step.folder} && {step.text}"
    timed(step.text, ["chroot", str(root), "/bin/sh", "-c", inside], environment)
    for mount in reversed(mounts):
        subprocess.run(["umount", mount[-1]], check=True)
    for at in made:
        at.rmdir()


def timed(what: str, command: list[str], environment: dict[str, str] | None = None) -> None:
    """Run a command, and say how long it took; end where it fails, with what it said."""
    start = time.monotonic()
    done = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False
    )
    print(f"{time.monotonic() - start:7.1f} s  {' '.join(what.split())[:80]}", flush=True)
    if done.returncode:
        sys.exit(done.stdout.decode(errors="replace")[-4000:])


def size(folder: Path) -> int:
    """Bytes of all files in ``folder``, each counted once."""
    files = {}
    for path in folder.rglob("*"):
        if path.is_file() and not path.is_symlink():
            status = path.lstat()
            files[status.st_ino] = status.st_size
    return sum(files.values())


if __name__ == "__main__":
    main()
