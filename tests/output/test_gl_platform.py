"""Where OpenGL comes from, with and without libraries."""

from __future__ import annotations

import ctypes
import ctypes.util
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.errors import RendererUnavailable
from app.output import gl_platform
from app.output.gl_platform import draft_problem, find_platform, gpu_device
from tests.children import run

SHARED = ("GL", "Xrender")
"""What pyglet loads, whatever draws."""


class Machine:
    """Which libraries the dynamic linker finds."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.libraries: set[str] = set()
        monkeypatch.setattr(ctypes.util, "find_library", self._find)
        monkeypatch.setattr(ctypes, "CDLL", self._load)

    def _find(self, name: str) -> str | None:
        return f"lib{name}.so.1" if name in self.libraries else None

    def _load(self, name: str) -> None:
        raise OSError(name)


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Iterator[Machine]:
    gl_platform.library_exists.cache_clear()
    yield Machine(monkeypatch)
    gl_platform.library_exists.cache_clear()


def test_osmesa_comes_before_egl_in_software(machine: Machine) -> None:
    machine.libraries = {"OSMesa", "EGL", *SHARED}
    assert find_platform("auto") == "osmesa"


def test_egl_is_taken_where_there_is_no_osmesa(machine: Machine) -> None:
    machine.libraries = {"EGL", *SHARED}
    assert find_platform("auto") == "egl"


@pytest.mark.parametrize("missing", SHARED)
@pytest.mark.parametrize(("platform", "library"), [("osmesa", "OSMesa"), ("egl", "EGL")])
def test_each_platform_needs_what_pyglet_loads(
    machine: Machine, platform: gl_platform.Platform, library: str, missing: str
) -> None:
    machine.libraries = {library, *SHARED} - {missing}
    package = f"lib{missing.lower()}1"
    with pytest.raises(RendererUnavailable, match=rf"has no lib{missing}: .*\b{package}\b"):
        find_platform(platform)


def test_a_wish_is_not_overruled(machine: Machine) -> None:
    machine.libraries = {"EGL", *SHARED}
    assert find_platform("egl") == "egl"
    with pytest.raises(RendererUnavailable, match="libOSMesa"):
        find_platform("osmesa")


def test_the_problem_says_what_is_missing_and_how_to_install_it(machine: Machine) -> None:
    machine.libraries = set()
    problem = draft_problem()
    assert problem is not None
    for part in ("libOSMesa and libGL", "libEGL", "apt-get install libosmesa6 libgl1", "libegl1"):
        assert part in problem


def test_there_is_no_problem_where_a_library_is_found(machine: Machine) -> None:
    machine.libraries = {"OSMesa", *SHARED}
    assert draft_problem() is None


def test_a_gpu_is_a_number_or_nothing() -> None:
    device = gpu_device()
    assert device is None or device >= 0


def test_looking_for_problems_loads_no_opengl() -> None:
    probe = """
import sys
from app.output.gl_platform import draft_problem
draft_problem()
assert not {"OpenGL", "pyrender", "trimesh", "scipy"} & set(sys.modules)
with open("/proc/self/maps") as maps:
    assert "OSMesa" not in maps.read()
"""
    done = run([sys.executable, "-c", probe], cwd=Path(__file__).parents[2])
    assert done.returncode == 0, done.stderr
