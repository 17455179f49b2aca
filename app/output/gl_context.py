"""The one OpenGL context of a process, and the one thread that it belongs to."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeVar

from app.errors import RendererUnavailable
from app.output.gl_platform import Choice, choose_platform

if TYPE_CHECKING:
    from app.output.draft_renderer import DraftRenderer

Result = TypeVar("Result")


def with_renderer(draw: Callable[[DraftRenderer], Result]) -> Result:
    """Let ``draw`` use the renderer of this process, on its thread, and wait.

    Every call comes to the same thread and context, whatever thread asks: EGL refuses a context
    to a second thread, and deleting one of its renderers breaks the others. Raises
    `RendererUnavailable` where there is no OpenGL.
    """
    return begin_with_renderer(draw).result()


def begin_with_renderer(draw: Callable[[DraftRenderer], Result]) -> Future[Result]:
    """As `with_renderer`, without waiting."""
    return _thread().submit(lambda: draw(_renderer()))


def has_renderer() -> bool:
    """Whether this process has begun to draw, and so has what that takes."""
    return _renderer.cache_info().currsize > 0


@lru_cache(maxsize=1)
def _thread() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(max_workers=1, thread_name_prefix="opengl")


@lru_cache(maxsize=1)
def _renderer() -> DraftRenderer:
    choice = choose_platform()
    try:
        _make_context(choice)
    except Exception as problem:  # whatever a driver or its binding comes up with
        raise RendererUnavailable(
            f"OpenGL was found ({choice.platform}) but does not start: {problem!r}. "
            "TUBELOOM_GL_PLATFORM=osmesa or egl chooses another way."
        ) from problem
    from app.output.draft_renderer import DraftRenderer

    return DraftRenderer()


def _make_context(choice: Choice) -> None:
    import OpenGL.contextdata

    # OSMesa's contexts come from ctypes as a new pointer object each time. PyOpenGL and pyrender
    # use them as keys, of which none would ever equal another: every picture would compile its
    # shaders anew and leave 39 MB behind. The pointer's value is the same each time.
    OpenGL.contextdata.getContext = _by_value(OpenGL.contextdata.getContext)

    platform: Any
    if choice.platform == "osmesa":
        from pyrender.platforms.osmesa import OSMesaPlatform

        platform = OSMesaPlatform(1, 1)
    else:
        from pyrender.platforms.egl import EGLPlatform, get_device_by_index

        platform = EGLPlatform(1, 1, device=get_device_by_index(choice.device))
    platform.init_context()
    platform.make_current()
    _contexts.append(platform)


_contexts: list[Any] = []
"""pyrender destroys a context whose platform is no longer referred to."""


def _by_value(get_context: Callable[..., Any]) -> Callable[..., Any]:
    def get_context_value(context: Any = None) -> Any:
        found = get_context(context)
        return found if isinstance(found, int) else ctypes.cast(found, ctypes.c_void_p).value

    return get_context_value
