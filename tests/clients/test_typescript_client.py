"""The client for TypeScript, compiled strictly, against the real service."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.clients.test_python_client import free_port
from tests.conftest import require
from tests.service import PATIENCE_SECONDS, SMALL, Service, running_service

PACKAGE = Path(__file__).parents[2] / "clients" / "typescript"
DRIVERS = Path(__file__).with_name("typescript")


def tool(name: str) -> str:
    """A program of the package's that it is made with."""
    return str(PACKAGE / "node_modules" / ".bin" / name)


def run(*command: str, folder: Path | None = None) -> str:
    """What a command writes; it must succeed."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def installed(folder: Path, scripts: Mapping[str, str]) -> None:
    """Install the package in ``folder`` as npm would, and compile scripts that use it."""
    require(shutil.which("node"), "node is not installed")
    require((PACKAGE / "node_modules").exists(), "run `npm ci` in clients/typescript")
    package = folder / "node_modules" / "tubeloom-client"
    package.mkdir(parents=True)
    shutil.copy(PACKAGE / "package.json", package)
    run(tool("tsc"), "--project", str(PACKAGE), "--outDir", str(package / "dist"))
    for name, text in scripts.items():
        (folder / name).write_text(text)
    options = json.loads((PACKAGE / "tsconfig.json").read_text())["compilerOptions"]
    options |= {"rootDir": ".", "outDir": ".", "declaration": False}
    wanted = {"compilerOptions": options, "include": ["*.ts"], "exclude": []}
    (folder / "tsconfig.json").write_text(json.dumps(wanted))
    (folder / "package.json").write_text('{"type": "module"}')
    run(tool("tsc"), folder=folder)


@pytest.fixture(scope="module")
def drivers(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder where our scripts lie compiled, beside the package."""
    folder = tmp_path_factory.mktemp("drivers")
    installed(folder, {path.name: path.read_text() for path in DRIVERS.glob("*.ts")})
    return folder


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    with running_service(tmp_path_factory.mktemp("service"), workers=1) as service:
        yield service


def test_the_calls_that_everyone_needs(drivers: Path, service: Service) -> None:
    posted, stored, jobs = json.loads(run("node", "calls.js", service.url, folder=drivers))
    assert posted["items"] == ["x", "y", "z"]
    assert len(posted["segments"]) == 1
    assert (posted["picture"], posted["scene"]) == ("PNG", "glTF")
    assert posted["bad"] == [422, "inconsistent-document", ["/items/1/id"]]
    assert stored == {
        "missing": 404,
        "again": 412,
        "late": 412,
        "added": ["w"],
        "digests": [True, True],
        "name": ["Typed", "Typed"],
        "items": ["x", "y", "z"],
        "revisions": [5, 4, 3, 2, 1],
        "delta": "glTF",
        "happenings": [*(["revision", number] for number in range(2, 6)), ["deleted", 6]],
    }
    assert jobs == {
        "made": "PNG",
        "same": True,
        "end": ["done", 1],
        "failed": "inconsistent-document",
        "stopped": ["Error: enough", "cancelled"],
    }


def test_nothing_is_missed_when_the_service_is_killed_while_one_watches(
    drivers: Path, tmp_path: Path
) -> None:
    port = free_port()
    with ExitStack() as stack:
        with running_service(tmp_path, workers=1, port=port) as service:
            with service.client() as client:
                client.put("/v1/programs/outlives", json=SMALL).raise_for_status()
                watcher = stack.enter_context(watching(drivers, service, "outlives"))
                assert heard(watcher) == {"kind": "current", "revision": 1}
                change(client, "before")
                assert heard(watcher)["name"] == "before"
            service.process.kill()
            service.process.wait()
        with running_service(tmp_path, workers=1, port=port) as service:
            with service.client() as client:
                for number in range(20):
                    change(client, str(number))
                client.delete("/v1/programs/outlives").raise_for_status()
            rest, _ = watcher.communicate(timeout=PATIENCE_SECONDS)
        told = [json.loads(line) for line in rest.splitlines()]
        assert [each["revision"] for each in told] == list(range(3, 24))
        assert [each["name"] for each in told[:-1]] == [str(number) for number in range(20)]
        assert told[-1] == {"kind": "deleted", "revision": 23}
        assert watcher.returncode == 0


@contextmanager
def watching(drivers: Path, service: Service, program: str) -> Iterator[subprocess.Popen[str]]:
    """A process that writes down what happens to a program."""
    command = ["node", "watch.js", service.url, program]
    watcher = subprocess.Popen(command, cwd=drivers, stdout=subprocess.PIPE, text=True)
    try:
        yield watcher
    finally:
        watcher.kill()
        watcher.communicate()


def heard(watcher: subprocess.Popen[str]) -> dict[str, Any]:
    """What it writes next."""
    assert watcher.stdout is not None
    found: dict[str, Any] = json.loads(watcher.stdout.readline())
    return found


def change(client: httpx.Client, name: str) -> None:
    """Make a revision."""
    headers = {"Content-Type": "application/merge-patch+json"}
    body = json.dumps({"name": name}).encode()
    client.patch("/v1/programs/outlives", content=body, headers=headers).raise_for_status()


def test_a_wrong_key_is_a_problem_and_silence_an_error(drivers: Path, tmp_path: Path) -> None:
    nobody = f"http://127.0.0.1:{free_port()}"
    with running_service(tmp_path, workers=1, auth="required") as service:
        said = run("node", "keys.js", service.url, nobody, folder=drivers)
    assert json.loads(said) == ["401", "TypeError"]


def test_its_types_are_those_of_the_interface(
    drivers: Path, service: Service, tmp_path: Path
) -> None:
    assert drivers
    with service.client() as client:
        (tmp_path / "openapi.json").write_bytes(client.get("/openapi.json").content)
    made = tmp_path / "schema.ts"
    options = json.loads((PACKAGE / "package.json").read_text())["scripts"]["generate"].split()
    words = [word for word in options[1:] if word.startswith("--") and word != "--output"]
    run(tool(options[0]), str(tmp_path / "openapi.json"), *words, "--output", str(made))
    kept = (PACKAGE / "src" / "schema.ts").read_text()
    assert made.read_text() == kept, "make openapi"


def test_it_needs_nothing_at_run_time() -> None:
    package = json.loads((PACKAGE / "package.json").read_text())
    assert "dependencies" not in package
