"""Which of Mitsuba's variants this machine can run: vectorised by LLVM, or else scalar."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

from app.errors import RendererUnavailable

OLDEST_LLVM = 17
"""15 and 16 write code for new processors that ends the process."""

PROBE_SECONDS = 60.0

_LIBRARIES = (
    "lib/*/libLLVM*.so*",
    "lib/llvm-*/lib/libLLVM*.so*",
    "lib64/libLLVM*.so*",
)

_PROBE = """
import mitsuba as mi
mi.set_variant("llvm_ad_rgb")
sphere = {"type": "sphere", "bsdf": {"type": "diffuse"}}
film = {"type": "hdrfilm", "width": 8, "height": 8}
place = mi.ScalarTransform4f().translate([0, 0, -5])
eye = {"type": "perspective", "film": film, "to_world": place}
scene = {"type": "scene", "sky": {"type": "constant"}, "ball": sphere, "eye": eye}
scene["path"] = {"type": "path"}
import numpy as np
assert np.array(mi.render(mi.load_dict(scene), spp=4)).mean() > 0
"""


def final_problem() -> str | None:
    """Why this machine cannot draw final pictures, if it cannot."""
    if importlib.util.find_spec("mitsuba") is None:
        return "The package mitsuba is not installed."
    return None


@lru_cache(maxsize=1)
def mitsuba() -> ModuleType:
    """Mitsuba, with a variant chosen for good. Raises `RendererUnavailable`.

    LLVM's code generator can end the process, so it is tried in another one first.
    """
    problem = final_problem()
    if problem is not None:
        raise RendererUnavailable(problem)
    llvm = _usable_llvm()
    if llvm is not None:
        os.environ["DRJIT_LIBLLVM_PATH"] = llvm
    import mitsuba as loaded

    loaded.set_variant("scalar_rgb" if llvm is None else "llvm_ad_rgb")
    loaded.set_log_level(loaded.LogLevel.Error)
    return loaded


def is_vectorised(renderer: Any) -> bool:
    """Whether the variant computes whole pictures at once."""
    return str(renderer.variant()).startswith("llvm")


def _usable_llvm() -> str | None:
    """The newest LLVM that draws a test picture."""
    return next((path for path in llvm_libraries() if _draws(path)), None)


def llvm_libraries() -> list[str]:
    """Paths of LLVM libraries, the newest first; or only the one that the environment names."""
    named = os.environ.get("DRJIT_LIBLLVM_PATH")
    if named:
        return [named]
    found = {str(path.resolve()) for pattern in _LIBRARIES for path in Path("/usr").glob(pattern)}
    versions = {path: llvm_version(path) for path in found}
    return sorted(
        (path for path, version in versions.items() if version >= OLDEST_LLVM),
        key=lambda path: (-versions[path], path),
    )


def llvm_version(path: str) -> int:
    """The major version of an LLVM library by its name; 0 where it does not tell.

    >>> llvm_version("/usr/lib/libLLVM.so.19.1"), llvm_version("/usr/lib/libLLVM-15.so.1")
    (19, 15)
    """
    found = re.search(r"libLLVM(?:-(\d+)|\.so\.(\d+))", path)
    return int(found[1] or found[2]) if found else 0


def _draws(path: str) -> bool:
    try:
        done = subprocess.run(  # noqa: S603 - our own interpreter and program
            [sys.executable, "-c", _PROBE],
            env={**os.environ, "DRJIT_LIBLLVM_PATH": path},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=PROBE_SECONDS,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0
