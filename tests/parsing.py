"""Python before 3.11.8 may fail to parse where garbage is collected in the midst of it.

Until then it counted how deep it is in the making of a syntax tree in one place for all trees. A
collection at that moment runs what finalizers there are, and may let another thread go on; if any
of that makes a tree, too, the first one ends as "SystemError: AST constructor recursion depth
mismatch" (https://github.com/python/cpython/issues/106905). Hypothesis, Schemathesis and pytest
parse a lot, and all tests leave garbage.
"""

from __future__ import annotations

import ast
import gc
import sys
from typing import Any

IS_AFFECTED = sys.version_info < (3, 11, 8)

_parse = ast.parse


def parse_without_collecting(*args: Any, **options: Any) -> Any:
    """What `ast.parse` gives; no garbage is collected meanwhile."""
    if not gc.isenabled():
        return _parse(*args, **options)
    gc.disable()
    try:
        return _parse(*args, **options)
    finally:
        gc.enable()
