"""Consistent documents of every sort, for Hypothesis."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

IDS = ("a", "b", "c", "ä/~", "e e", "6")

coordinates = st.integers(-1_000_000, 1_000_000) | st.floats(-1e6, 1e6)
lengths = st.integers(1, 100_000) | st.floats(1e-3, 1e5)
vectors = st.lists(coordinates, min_size=3, max_size=3)
directions = vectors.filter(any)
colors = st.from_regex(r"#[0-9a-fA-F]{3}([0-9a-fA-F]{3})?", fullmatch=True)
materials = st.sampled_from(("plastic", "metal", "glass", "matte"))
labels = st.text(st.characters(codec="utf-8"), max_size=20)
data = st.dictionaries(
    labels,
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
        | labels,
        lambda inner: st.lists(inner, max_size=3) | st.dictionaries(labels, inner, max_size=3),
        max_leaves=8,
    ),
    max_size=3,
)  # fmt: skip


def shape(name: str, *keys: str) -> st.SearchStrategy[dict[str, Any]]:
    sizes = {key: st.lists(lengths, min_size=3, max_size=3) if key == "size" else lengths
             for key in keys}  # fmt: skip
    return st.fixed_dictionaries({"type": st.just(name)}, optional=sizes)


trees = st.recursive(
    shape("box").map(lambda box: {**box, "size": [1, 2, 3]})
    | shape("sphere").map(lambda ball: {**ball, "radius": 1}),
    lambda inner: st.fixed_dictionaries(
        {
            "type": st.sampled_from(("union", "intersection", "difference")),
            "of": st.lists(inner, min_size=1, max_size=3),
        },
        optional={"position": vectors},
    ),
    max_leaves=5,
)

shapes = st.one_of(
    trees.map(lambda tree: {"type": "csg", "tree": tree}),
    shape("box", "size"),
    shape("tray", "size", "wall"),
    shape("sphere", "radius"),
    shape("cylinder", "radius", "height"),
    shape("cone", "radius", "height"),
    shape("arrow", "length", "radius"),
)


@st.composite
def items(draw: st.DrawFn) -> list[dict[str, Any]]:
    """Each may lie within one that came before it."""
    made: list[dict[str, Any]] = []
    for name in IDS[: draw(st.integers(1, len(IDS)))]:
        parents = st.sampled_from([item["id"] for item in made]) if made else st.nothing()
        points = st.lists(st.sampled_from(IDS), unique=True, max_size=2).flatmap(
            lambda ids: st.tuples(
                *(
                    st.fixed_dictionaries(
                        {"id": st.just(point), "position": vectors},
                        optional={"direction": directions},
                    )
                    for point in ids
                )
            )
        )
        optional = {
            "kind": st.none() | st.just("variable"), "label": labels, "shape": shapes,
            "position": vectors, "rotation": vectors.map(lambda v: [x / 10 for x in v]),
            "material": materials, "color": colors,
            "attachment_points": points.map(list), "data": data,
        }  # fmt: skip
        if made:
            optional["parent"] = parents
        made.append(draw(st.fixed_dictionaries({"id": st.just(name)}, optional=optional)))
    return made


@st.composite
def documents(draw: st.DrawFn) -> dict[str, Any]:
    """Documents that follow the schema and do not contradict themselves."""
    things = draw(items())
    ends = [{"item": item["id"]} for item in things] + [
        {"item": item["id"], "point": point["id"]}
        for item in things
        for point in item.get("attachment_points", ())
    ]
    hyperedges = []
    if len(ends) > 1:
        chosen = st.lists(
            st.sampled_from(ends), min_size=2, unique_by=lambda end: tuple(end.items())
        )
        optional = {
            "kind": st.just("coreference"), "label": labels, "color": colors, "radius": lengths,
            "join_height": st.none() | coordinates, "material": materials, "data": data,
        }  # fmt: skip
        hyperedges = [
            draw(
                st.fixed_dictionaries(
                    {"id": st.just(str(number)), "attachments": chosen}, optional=optional
                )
            )
            for number in range(draw(st.integers(0, 3)))
        ]
    return draw(
        st.fixed_dictionaries(
            {"items": st.just(things)},
            optional={
                "name": labels,
                "notation": st.just("sparcl"),
                "hyperedges": st.just(hyperedges),
                "layout": st.fixed_dictionaries(
                    {}, optional={"curves": st.sampled_from(("prose", "symbolic")),
                                  "clearance": st.floats(0, 1e5)},
                ),
                "style": st.fixed_dictionaries(
                    {}, optional={"background": colors | st.just("transparent"),
                                  "labels": st.booleans()},
                ),
                "view": st.fixed_dictionaries({}, optional={"from": directions}),
                "data": data,
            },
        )
    )  # fmt: skip
