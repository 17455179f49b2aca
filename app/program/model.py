"""The document (`Program`) and its parts, as they stand in JSON."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, Strict

from app.program.base import Color, Data, Degrees, Id, Label, Length, Many, Part, Tallied, Vector
from app.program.shapes import Shape

Share = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
MaterialName = Literal["plastic", "metal", "glass", "wood", "stone", "matte", "plain"]
Routing = Literal["planes", "elastic", "auto"]
Flow = Literal["in", "out", "both"]
PlacementMode = Literal["rows", "layers", "ground", "sheet", "space", "auto"]
Bundles = Literal["none", "thick"]
Clearance = Annotated[float, Field(ge=0, le=1e5, allow_inf_nan=False)]
Finish = Literal["shiny", "satin", "matte"]

TRANSLUCENCY = "Share of light that passes; left out, the material's own."


class AttachmentPoint(Part):
    """A named place on an item where a hyperedge may end."""

    id: Id
    position: Vector = Field(description="Relative to the item's centre, in its own axes.")
    direction: Vector = Field((0.0, 0.0, 1.0), description="Outward, in the item's own axes.")


class Item(Part):
    """A thing in the program."""

    id: Id
    kind: Id | None = Field(None, description="What it means; the notation says how that looks.")
    label: Label | None = None
    parent: Id | None = Field(None, description="The item that contains this one.")
    shape: Shape | None = None
    position: Vector | None = Field(
        None, description="Centre, relative to the parent's centre (a root: to the world)."
    )
    rotation: Annotated[tuple[Degrees, Degrees, Degrees], Strict(strict=False)] | None = Field(
        None, description="Degrees about x, then y, then z, relative to the parent."
    )
    material: MaterialName | None = None
    finish: Finish | None = None
    translucency: Share | None = Field(None, description=TRANSLUCENCY)
    color: Color | None = None
    attachment_points: Many[AttachmentPoint] = ()
    data: Data = Field(
        default_factory=dict, description="The editor's own; handed through to glTF extras."
    )


class Attachment(Part):
    """One end of a hyperedge."""

    item: Id
    point: Id | None = Field(
        None,
        description="Left out: the middle of the item's top face. Hyperedges that would end at the "
        "same place get places side by side.",
    )
    flow: Flow | None = Field(
        None,
        description="Which way it goes, seen from the item: 'out' of an item that drives the "
        "hyperedge, 'in' to one that takes from it. Left out, nothing is known.",
    )


class Hyperedge(Part):
    """A relation that joins two or more attachments."""

    id: Id
    kind: Id | None = None
    label: Label | None = None
    attachments: Many[Attachment] = Field(min_length=2)
    color: Color | None = None
    radius: Length | None = None
    join_height: float | None = Field(
        None,
        ge=-1e6,
        le=1e6,
        allow_inf_nan=False,
        description="World z of the join plane; left out, Tubeloom chooses.",
    )
    material: MaterialName | None = None
    finish: Finish | None = None
    translucency: Share | None = Field(None, description=TRANSLUCENCY)
    data: Data = Field(default_factory=dict)


class LineUp(Part):
    """Siblings without positions that stand in one row or column, in the order given."""

    type: Literal["row", "column"]
    items: Many[Annotated[Id, Tallied]] = Field(min_length=2)


class Helix(Part):
    """Siblings without positions that climb around an upright axis, in the order given."""

    type: Literal["helix"]
    items: Many[Annotated[Id, Tallied]] = Field(min_length=2)
    radius: Length | None = Field(
        None, description="Of the line that the items' middles are on; left out, as they need."
    )
    pitch: Length | None = Field(None, description="Rise of one turn; left out, as they need.")
    items_per_turn: float | None = Field(
        None, ge=0.1, le=1e4, allow_inf_nan=False, description="Left out, eight or what fits."
    )
    rotate: bool = Field(True, description="Whether each item turns its front outward.")
    tilt: Degrees = Field(0.0, description="How far the tops of turned items lean outward.")
    start: Degrees = Field(
        0.0, description="Where the first one stands: from the front, to the right."
    )
    clockwise: bool = Field(False, description="Which way it climbs, seen from above.")


Constraint = Annotated[LineUp | Helix, Field(discriminator="type")]


class Layout(Part):
    """How places and curves are found."""

    dimensions: Literal[2, 3] = Field(
        3, description="2: a flat drawing, seen from above, whose lines may cross."
    )

    curves: Literal["steiner", "prose", "symbolic"] | None = Field(
        None,
        description="'steiner': short trees, woven clear of each other; the default but with "
        "fidelity 'paper'. 'prose', 'symbolic': the paper's CURVES by its words or its symbols.",
    )
    fidelity: Literal["best", "paper"] = Field(
        "best",
        description="'paper': exactly its curves ('prose' by default). 'best': tubes leave items "
        "squarely.",
    )
    closest: Literal["space", "plane"] = Field(
        "space", description="Whether CLOSEST measures in three dimensions or seen from above."
    )
    tube: Literal["swept", "patches"] = Field(
        "swept", description="A swept circle, or the paper's pair of Bezier patches."
    )
    patch_rule: Literal["paper", "fitted"] = Field(
        "paper", description="Where patch control points go: by the paper, or fitted to the tube."
    )
    clearance: Clearance | None = Field(
        0.05,
        description="Wanted between tubes' surfaces, and from items; null: do not look.",
    )
    routing: Routing = Field(
        "auto",
        description="How 'steiner' curves keep clear of each other. 'elastic': they are relaxed as "
        "elastic chains that push each other apart. 'planes': each hyperedge has a height of its "
        "own. 'auto': elastic where that is proven clear, else whichever has fewer faults.",
    )
    placement: PlacementMode = Field(
        "rows",
        description="Where items without positions go. 'rows': in rows, by what contains them. "
        "'layers': upright, in columns from left to right as the hyperedges flow, with curves that "
        "run level and turn in the channels between the columns. 'ground', 'sheet', 'space': what "
        "hyperedges join stands together, on the ground, on an upright sheet that faces the "
        "reader, or in space. 'auto': as suits the program.",
    )
    bundles: Bundles | None = Field(
        None,
        description="'thick': the bits of a bus of a netlist are one hyperedge. Left out: 'thick' "
        "in layers, else 'none'.",
    )
    constraints: Many[Constraint] = ()


class Style(Part):
    """How the scene looks as a whole."""

    palette: str = Field("glasbey", max_length=100)
    background: Color | Literal["transparent"] = "#ffffff"
    labels: bool = True
    ground: bool = True
    halo: float = Field(
        0.3,
        ge=0,
        le=3,
        allow_inf_nan=False,
        description="Gap in what a tube passes in front of, in radii of the tube; 0: none. Of "
        "drafts and drawings.",
    )
    hidden_lines: Literal["removed", "dashed"] = Field(
        "removed", description="In drawings: what becomes of lines behind something."
    )


class View(Part):
    """Where the scene is seen from."""

    projection: Literal["perspective", "orthographic"] = "perspective"
    from_: Vector | None = Field(
        None,
        alias="from",
        description="Direction from the scene to the camera; left out, what suits the placement: "
        "from above on what stands on the ground, from the front on a sheet.",
    )
    field_of_view: float = Field(
        30.0, ge=1, le=120, allow_inf_nan=False, description="Vertical, in degrees."
    )
    margin: float = Field(
        0.05, ge=0, le=0.45, allow_inf_nan=False, description="Free share of the picture's edge."
    )
    stereo: Literal["side-by-side", "anaglyph"] | None = Field(
        None,
        description="Two eyes: beside each other (left eye left), or as red and cyan in one.",
    )
    eye_distance: float | None = Field(
        None,
        ge=0,
        le=0.2,
        allow_inf_nan=False,
        description="Between the eyes, as a share of the distance to the scene; left out, what "
        "suits the scene's depth.",
    )


class Program(Part):
    """A document: items, and the hyperedges that join their attachment points."""

    name: Label | None = None
    notation: str = Field("plain", max_length=100)
    items: Many[Item]
    hyperedges: Many[Hyperedge] = ()
    layout: Layout = Layout()
    style: Style = Style()
    view: View = View()
    data: Data = Field(default_factory=dict)
