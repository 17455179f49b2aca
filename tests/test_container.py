"""What the container's files name is there; `docker/prove.sh` builds and runs it."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from app.settings import Settings

ROOT = Path(__file__).parents[1]
DOCKER = ROOT / "docker"
DOCKERFILE = (DOCKER / "Dockerfile").read_text()


def test_everything_that_is_copied_is_there_and_is_sent_to_the_builder() -> None:
    sent = (DOCKER / "Dockerfile.dockerignore").read_text().split()
    assert sent[0] == "*"
    copied = set()
    for line in re.findall(r"^COPY (.*)$", DOCKERFILE, re.MULTILINE):
        words = [word for word in shlex.split(line) if not word.startswith("--chmod")]
        if not words[0].startswith("--from"):
            copied |= set(words[:-1])
    assert {f"!{path}" for path in copied} == {each for each in sent if each.startswith("!")}
    assert [path for path in copied if not (ROOT / path).exists()] == []


def test_every_setting_that_is_made_exists() -> None:
    known = {f"TUBELOOM_{name.upper()}" for name in Settings.model_fields}
    composed = (DOCKER / "compose.yaml").read_text()
    made = set(re.findall(r"\b(TUBELOOM_[A-Z_]+)[=:]", DOCKERFILE + composed))
    assert {"TUBELOOM_DATA_FOLDER", "TUBELOOM_DATABASE", "TUBELOOM_DASK_SCHEDULER"} <= made
    assert made <= known


def test_packages_are_those_of_the_lock_with_hashes() -> None:
    assert "--require-hashes -r requirements.lock" in " ".join(DOCKERFILE.split())
    lock = (ROOT / "requirements.lock").read_text()
    assert len(re.findall(r"^[A-Za-z0-9._-]+==", lock, re.MULTILINE)) > 30
    assert "--hash=sha256:" in lock
