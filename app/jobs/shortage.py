"""Whether an error says that memory ran out: each library says so in its own way."""

from __future__ import annotations

import errno
from collections.abc import Iterator

from app.answers import Options, RenderOptions
from app.errors import OutOfMemory, TubeloomError
from app.output.memory_needs import NotEnoughMemoryError
from app.picture_limits import advice, in_gib, is_drawn
from app.settings import Settings

_PHRASES = (
    "out of memory",  # Dr.Jit, Open Image Denoise, OpenGL
    "bad_alloc",  # manifold3d, and other C++
    "bad array new length",
    "cannot allocate memory",
    "unable to allocate",  # NumPy
    "failed to allocate",
    "could not allocate",
    "can't start new thread",
    "failed to map segment",  # a library that is loaded
)
"""What messages contain that say so, in small letters."""

_GL_OUT_OF_MEMORY = 0x0505


def shortage(error: BaseException, options: Options, settings: Settings) -> OutOfMemory | None:
    """The error of the domain, if ``error`` or what it came from says that memory ran out."""
    if not any(_says_so(each) for each in _origins(error)):
        return None
    most = in_gib(settings.max_worker_bytes)
    said = f"The answer would take more than the {most} of memory that a worker may take."
    if isinstance(options, RenderOptions) and is_drawn(options):
        totals = (each.total for each in _origins(error) if isinstance(each, NotEnoughMemoryError))
        return OutOfMemory(
            f"{said} {advice(options, settings.max_worker_bytes, next(totals, None))}"
        )
    more = f"TUBELOOM_MAX_WORKER_BYTES={2 * settings.max_worker_bytes}"
    return OutOfMemory(f"{said} A smaller document would do, or {more}.")


def _says_so(error: BaseException) -> bool:
    if isinstance(error, MemoryError):
        return True
    if isinstance(error, OSError) and error.errno == errno.ENOMEM:
        return True
    if getattr(error, "err", None) == _GL_OUT_OF_MEMORY and type(error).__name__ == "GLError":
        return True
    # What Tubeloom itself says may quote a document.
    if isinstance(error, TubeloomError):
        return False
    said = str(error).lower()
    return any(phrase in said for phrase in _PHRASES)


def _origins(error: BaseException) -> Iterator[BaseException]:
    """The error, and those that it came from."""
    seen: set[int] = set()
    found: BaseException | None = error
    while found is not None and id(found) not in seen:
        seen.add(id(found))
        yield found
        # An error of ours that has no cause was raised for a reason of its own.
        found = found.__cause__ or (None if isinstance(found, TubeloomError) else found.__context__)
