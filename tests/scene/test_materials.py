from __future__ import annotations

from typing import get_args

import numpy as np
import pytest

from app.program.model import MaterialName
from app.scene.color import srgb_of
from app.scene.materials import SURFACES, make_material, make_materials


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
    many = make_materials(["matte", "metal"], np.array([srgb_of("#123456"), srgb_of("#fedcba")]))
    assert many == [make_material("matte", "#123456"), make_material("metal", "#fedcba")]
