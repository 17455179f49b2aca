"""Bodies of trees of constructive solid geometry, kept as long as there is room."""

from __future__ import annotations

from collections import OrderedDict
from threading import Lock

from app.solids.csg import Body, make_body
from app.solids.csg_tree import Tree

MOST_KEPT = 1_000_000
"""Triangles of all bodies that are kept, some 50 megabytes; a body counts as a thousand more."""


class _Kept:
    """The bodies that were asked for last."""

    def __init__(self) -> None:
        self._bodies: OrderedDict[Tree, Body] = OrderedDict()
        self._weight = 0
        self._lock = Lock()

    def body(self, tree: Tree) -> Body:
        with self._lock:
            body = self._bodies.get(tree)
            if body is None:
                body = self._bodies[tree] = make_body(tree)
                for array in (body.mesh.vertices, body.mesh.normals, body.mesh.faces):
                    array.flags.writeable = False
                self._weight += _weight(body)
            self._bodies.move_to_end(tree)
            while self._weight > MOST_KEPT:
                self._weight -= _weight(self._bodies.popitem(last=False)[1])
        return body


def _weight(body: Body) -> int:
    return len(body.mesh.faces) + 1000


_kept = _Kept()


def body_of(tree: Tree) -> Body:
    """The body of ``tree``: the same arrays each time while it is kept, read-only.

    Raises what `app.solids.csg.make_body` does.
    """
    return _kept.body(tree)
