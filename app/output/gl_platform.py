"""Where OpenGL comes from: a GPU or Mesa in software, through EGL or OSMesa.

PyOpenGL decides at its import, by the environment variable PYOPENGL_PLATFORM, and never again:
so nothing here imports it, and `choose_platform` comes first in a process that draws.
"""

from __future__ import annotations

import ctypes
import ctypes.util
import os
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal, TypeAlias

from app.errors import RendererUnavailable
from app.settings import settings

Platform: TypeAlias = Literal["osmesa", "egl"]
Wish: TypeAlias = Literal["auto", "osmesa", "egl"]

_EGL_EXTENSIONS = 0x3055
_EGL_PLATFORM_DEVICE = 0x313F
_MOST_DEVICES = 16

_LIBRARIES: dict[Platform, tuple[str, ...]] = {
    "osmesa": ("OSMesa", "GL", "Xrender"),
    "egl": ("EGL", "GL", "Xrender"),
}
"""What each platform loads. libGL and libXrender are there for pyglet, which pyrender imports."""

_PACKAGES: dict[Platform, str] = {
    "osmesa": "libosmesa6 libgl1 libxrender1",
    "egl": "libegl1 libegl-mesa0 libgl1-mesa-dri libgl1 libxrender1",
}


@dataclass(frozen=True, slots=True)
class Choice:
    """A platform, and which of EGL's devices to draw on."""

    platform: Platform
    device: int = 0


def draft_problem() -> str | None:
    """What the draft renderer lacks on this machine and how to install it, or ``None``.

    Looks for libraries without loading them: half a second and 48 MB for OSMesa, which belong to
    a worker. Whether they draw, `app.output.draft.draw_pixel` tells.
    """
    try:
        find_platform(settings().gl_platform)
    except RendererUnavailable as problem:
        return str(problem)
    return None


def choose_platform() -> Choice:
    """Decide for this process, and tell PyOpenGL and pyrender through the environment.

    ``auto`` prefers a GPU, then OSMesa, then EGL in software. Raises `RendererUnavailable` where
    there is nothing to draw with.
    """
    wish = settings().gl_platform
    gpu = gpu_device() if wish != "osmesa" and _has("egl") else None
    choice = Choice(find_platform(wish)) if gpu is None else Choice("egl", gpu)
    os.environ["PYOPENGL_PLATFORM"] = choice.platform
    return choice


def find_platform(wish: Wish) -> Platform:
    """What to draw with where there is no GPU, as far as libraries tell.

    Raises `RendererUnavailable` where what is wished for, or anything at all, is missing.
    """
    wanted: tuple[Platform, ...] = ("osmesa", "egl") if wish == "auto" else (wish,)
    for platform in wanted:
        if _has(platform):
            return platform
    missing = " nor ".join(_missing(platform) for platform in wanted)
    ways = " or ".join(f"apt-get install {_PACKAGES[platform]}" for platform in wanted)
    raise RendererUnavailable(
        f"Draft pictures need OpenGL, and this machine has no {missing}: {ways}."
    )


@lru_cache(maxsize=1)
def gpu_device() -> int | None:
    """The number, among EGL's devices, of the first GPU that starts; for a process that draws.

    Without a device file there is no GPU, and libEGL is not even loaded.
    """
    files = [*Path("/dev/dri").glob("renderD*"), *Path("/dev").glob("nvidia[0-9]*")]
    if not any(os.access(file, os.R_OK | os.W_OK) for file in files):
        return None
    try:
        egl = _load("EGL")
    except OSError:
        return None
    devices = enumerate(_egl_devices(egl))
    return next((number for number, device in devices if _is_gpu(egl, device)), None)


def _egl_devices(egl: ctypes.CDLL) -> list[int]:
    """Handles of all devices, by the extension EGL_EXT_device_query."""
    query = _extension(
        egl, b"eglQueryDevicesEXT", ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p
    )
    count = ctypes.c_int()
    devices = (ctypes.c_void_p * _MOST_DEVICES)()
    if query is None or not query(_MOST_DEVICES, devices, ctypes.byref(count)):
        return []
    return [device for device in devices[: count.value] if device]


def _is_gpu(egl: ctypes.CDLL, device: int) -> bool:
    """Whether the device is not software, and comes up."""
    describe = _extension(
        egl, b"eglQueryDeviceStringEXT", ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int
    )
    get_display = _extension(
        egl,
        b"eglGetPlatformDisplayEXT",
        ctypes.c_void_p,
        ctypes.c_int,
        ctypes.c_void_p,
        ctypes.c_void_p,
    )
    if describe is None or get_display is None:
        return False
    if b"EGL_MESA_device_software" in (describe(device, _EGL_EXTENSIONS) or b""):
        return False
    display = ctypes.c_void_p(get_display(_EGL_PLATFORM_DEVICE, device, None))
    works = bool(display and egl.eglInitialize(display, None, None))
    if works:
        egl.eglTerminate(display)
    return works


def _extension(egl: ctypes.CDLL, name: bytes, *prototype: Any) -> Any:
    """A function that EGL hands out by name, or ``None``; its result's type comes first."""
    find = egl.eglGetProcAddress
    find.restype = ctypes.c_void_p
    address = find(name)
    return ctypes.CFUNCTYPE(*prototype)(address) if address else None


def _has(platform: Platform) -> bool:
    return all(library_exists(name) for name in _LIBRARIES[platform])


def _missing(platform: Platform) -> str:
    return " and ".join(f"lib{name}" for name in _LIBRARIES[platform] if not library_exists(name))


@lru_cache
def library_exists(name: str) -> bool:
    """Whether the dynamic linker knows the library, or would load it from LD_LIBRARY_PATH."""
    if ctypes.util.find_library(name) is not None:
        return True
    try:
        _load(name)
    except OSError:
        return False
    return True


def _load(name: str) -> ctypes.CDLL:
    """As PyOpenGL does: the plain name, then every version of it."""
    for version in ("", *(f".{number}" for number in range(9, 0, -1))):
        try:
            return ctypes.CDLL(f"lib{name}.so{version}")
        except OSError:
            continue
    raise OSError(f"lib{name} cannot be loaded")
