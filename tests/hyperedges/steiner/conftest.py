from __future__ import annotations

import numpy as np
import pytest

from app.hyperedges.steiner.meeting import meet, meeting_length
from benchmarks.shortest_trees import shortest_tree
from tests.hyperedges.steiner.measures import short_tree


@pytest.fixture(scope="package", autouse=True)
def compiled() -> None:
    """Compiling takes longer than Hypothesis lets a test take."""
    short_tree(np.eye(5, 3))
    shortest_tree(np.eye(4, 3))
    meet(np.eye(4, 3), 0, 1, 2, 3)
    meeting_length(np.eye(3), 0, 1, 2)
