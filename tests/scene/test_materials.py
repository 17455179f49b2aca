from __future__ import annotations

from typing import get_args

import numpy as np
import pytest

from app.program.model import MaterialName
from app.scene.color import srgb_of
from app.scene.materials import SURFACES, Look, in_white, make_material, make_materials


def test_every_material_of_the_document_is_there_and_described() -> None:
    assert set(SURFACES) == set(get_args(MaterialName))
    assert all(name == surface.name and surface.title for name, surface in SURFACES.items())


def test_only_metal_is_metallic_and_only_glass_is_translucent() -> None:
    assert [name for name, surface in SURFACES.items() if surface.metallic] == ["metal"]
    assert [name for name, surface in SURFACES.items() if surface.opacity < 1] == ["glass"]


def test_a_material_has_its_colour_as_light() -> None:
    glass = make_material("glass", "#808080")
    assert glass.name == "glass #808080"
    assert glass.base_color == pytest.approx((0.2158605, 0.2158605, 0.2158605, 0.35))


def test_equal_materials_are_equal() -> None:
    assert make_material("metal", "#ABC") == make_material("metal", "#aabbcc")


def test_many_materials_at_once_are_the_same_as_one_by_one() -> None:
    many = make_materials(
        [Look("matte"), Look("metal", "shiny")], np.array([srgb_of("#123456"), srgb_of("#fedcba")])
    )
    assert many == [
        make_material("matte", "#123456"),
        make_material(Look("metal", "shiny"), "#fedcba"),
    ]


def test_a_shiny_finish_is_smoother_than_a_matte_one() -> None:
    for name in get_args(MaterialName):
        shiny, satin, matte = (
            make_material(Look(name, finish), "#777").roughness
            for finish in ("shiny", "satin", "matte")
        )
        assert shiny < satin < matte or not SURFACES[name].is_lit


def test_translucency_is_what_a_document_says() -> None:
    for name in get_args(MaterialName):
        assert make_material(Look(name, translucency=0.75), "#777").base_color[3] == 0.25
    assert make_material(Look("glass", translucency=0.5), "#777").transmission == 0.5
    assert make_material(Look("plastic", translucency=0.5), "#777").transmission == 0


def test_materials_that_differ_have_names_that_differ() -> None:
    looks = [
        Look(name, finish, translucency)
        for name in get_args(MaterialName)
        for finish in (None, "shiny", "matte")
        for translucency in (None, 0.0, 0.5)
    ]
    made = [make_material(look, color) for look in looks for color in ("#123", "#321")]
    assert len({material.name for material in made}) == len(made)
    assert len({in_white(material) for material in made}) == len(looks)
