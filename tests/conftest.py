"""What every room's tests share."""

from __future__ import annotations

import os

import pytest


def require(condition: object, reason: str) -> None:
    """Skip the test where this machine lacks something; where CI is true, fail it instead."""
    if condition:
        return
    if os.environ.get("CI", "").lower() == "true":
        pytest.fail(f"CI has everything, but: {reason}")
    pytest.skip(reason)
