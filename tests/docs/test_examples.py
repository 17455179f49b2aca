"""What README and docs show is run as it stands there."""

import json
import re
from pathlib import Path

import pytest

from app.program.reading import read_program
from app.settings import Settings
from tests.service import Service
from tools.readme import check_picture, run_block

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def blocks(language: str) -> list[tuple[str, str]]:
    """The fenced blocks of one language, with the names of their pages."""
    fence = re.compile(rf"^```{language}\n(.*?)^```", re.MULTILINE | re.DOTALL)
    return [(page.name, block) for page in PAGES for block in fence.findall(page.read_text())]


SIGNATURES = {
    ".png": b"\x89PNG",
    ".glb": b"glTF",
    ".json": b"{",
    ".stl": b"Binary STL",
    ".3mf": b"PK",
}

COMMANDS = [
    pytest.param(block, id=f"{name} {number}")
    for number, (name, block) in enumerate(blocks("sh"))
    if not block.startswith("make ")
]


def cancel_jobs(service: Service) -> None:
    """Cancel what is still at work: nobody waits for it, and it would take minutes."""
    with service.client() as client:
        for job in client.get("/v1/jobs").json()["jobs"]:
            if job["state"] in {"waiting", "running"}:
                client.delete(job["links"]["self"]).raise_for_status()


@pytest.mark.parametrize("commands", COMMANDS)
def test_commands_do_what_they_say(commands: str, usual_service: Service, tmp_path: Path) -> None:
    done = run_block(commands, usual_service.url, tmp_path)
    cancel_jobs(usual_service)
    assert done.returncode == 0, done.stdout + done.stderr
    made = [path for path in tmp_path.iterdir() if path.is_file()]
    assert made or done.stdout
    for path in made:
        data = path.read_bytes()
        assert data.startswith(SIGNATURES[path.suffix])
        if path.suffix == ".png":
            check_picture(data)


@pytest.mark.parametrize(("page", "block"), blocks("json"))
def test_documents_in_the_docs_are_programs(page: str, block: str) -> None:
    assert page
    assert read_program(block.encode(), Settings()).items


def test_every_setting_is_described_with_its_default() -> None:
    page = (ROOT / "docs" / "settings.md").read_text()
    for name, field in Settings.model_fields.items():
        default = "" if field.default in {None, (), ""} else f"{field.default} "
        assert f"| `TUBELOOM_{name.upper()}` | {default}|" in page


def test_pages_link_to_what_exists() -> None:
    for page in PAGES:
        for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_document_page_names_every_key() -> None:
    block = json.loads(next(block for name, block in blocks("json") if name == "document.md"))
    program = read_program(json.dumps(block).encode(), Settings())
    for section in ("layout", "style", "view"):
        keys = {
            field.alias or name
            for name, field in type(getattr(program, section)).model_fields.items()
        }
        assert set(block[section]) == keys
