"""What a Dockerfile says, as steps: as much of its language as ours uses."""

from __future__ import annotations

import json
import re
import shlex
from dataclasses import dataclass, field, replace
from pathlib import Path

DOCKERFILE = Path(__file__).with_name("Dockerfile")


@dataclass(frozen=True)
class Step:
    """A RUN or a COPY, with all that holds when it is done."""

    kind: str
    text: str
    folder: str
    environment: dict[str, str]


@dataclass
class Stage:
    """What begins with FROM; in the end, how a container is run."""

    name: str
    base: str
    steps: list[Step] = field(default_factory=list)
    environment: dict[str, str] = field(default_factory=dict)
    arguments: dict[str, str] = field(default_factory=dict)
    folder: str = "/"
    user: str = "0"
    volumes: list[str] = field(default_factory=list)
    healthcheck: list[str] = field(default_factory=list)
    entrypoint: list[str] = field(default_factory=list)
    command: list[str] = field(default_factory=list)

    def take(self, kind: str, text: str) -> None:
        """Add an instruction. Raises `ValueError` for one that is not known here."""
        known = self.arguments | self.environment
        match kind:
            case "RUN" | "COPY":
                self.steps.append(Step(kind, text, self.folder, known))
            case "ARG":
                name, _, value = text.partition("=")
                self.arguments[name] = value
            case "ENV":
                for pair in shlex.split(text):
                    name, _, value = pair.partition("=")
                    self.environment[name] = re.sub(r"\$(\w+)", lambda m: known[m[1]], value)
            case "WORKDIR":
                self.folder = text
            case "USER":
                self.user = text
            case "VOLUME":
                self.volumes = json.loads(text)
            case "HEALTHCHECK":
                self.healthcheck = json.loads(text[text.index("CMD") + 3 :])
            case "ENTRYPOINT":
                self.entrypoint = json.loads(text)
            case "CMD":
                self.command = json.loads(text)
            case "EXPOSE":
                pass  # it tells people, and does nothing
            case _:
                raise ValueError(f"What is {kind}?")


def stages() -> list[Stage]:
    """The Dockerfile's stages."""
    found: list[Stage] = []
    lines = [line for line in DOCKERFILE.read_text().splitlines() if not line.startswith("#")]
    for instruction in "\n".join(lines).replace("\\\n", " ").splitlines():
        if not instruction.strip():
            continue
        kind, text = instruction.split(maxsplit=1)
        if kind == "FROM":
            base, _, name = text.partition(" AS ")
            found.append(_begun(name, base, found))
        else:
            found[-1].take(kind, text)
    return found


def _begun(name: str, base: str, before: list[Stage]) -> Stage:
    for stage in before:
        if stage.name == base:
            return replace(stage, name=name, base=base, steps=[], arguments={})
    return Stage(name, base)
