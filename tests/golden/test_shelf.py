"""Every shape in every material and quality, beside pictures that somebody looked at."""

from __future__ import annotations

import io
from collections.abc import Iterator

import flip_evaluator
import httpx
import numpy as np
import pytest
from PIL import Image

from app.arrays import Floats
from tests.golden.shelf import (
    COLUMNS,
    MATERIALS,
    QUALITIES,
    ROWS,
    SHAPES,
    document,
    path,
    query,
)
from tests.service import running_service

SEEN = 0.03
"""Mean difference of one shape's part of a picture by FLIP (Andersson et al. 2020: 0 is the same,
1 is black against white as they alternate on a screen) that nobody sees."""

NOISE_OF_GLASS = 0.06
"""Light in glass goes many ways: of other samples, 64 as here, it is up to 0.05 different."""

ALIKE = (("plastic", "metal"), ("plastic", "matte"), ("matte", "plain"))
"""Materials that are most easily taken for each other."""


@pytest.fixture(scope="module", params=["osmesa", "egl"])
def client(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[httpx.Client]:
    """A client of a service that draws with the platform."""
    folder = tmp_path_factory.mktemp(request.param)
    with (
        running_service(folder, gl_platform=request.param) as service,
        service.client() as client,
    ):
        yield client


def pixels(picture: Image.Image) -> Floats:
    return np.asarray(picture.convert("RGB"), dtype=np.float32) / 255


def differences(expected: Floats, found: Floats) -> dict[str, float]:
    """How different each shape looks, by FLIP."""
    each, _, _ = flip_evaluator.evaluate(expected, found, "LDR", applyMagma=False)
    parts = [
        part.mean()
        for row in np.array_split(each, ROWS, axis=0)
        for part in np.array_split(row, COLUMNS, axis=1)
    ]
    return dict(zip(SHAPES, parts, strict=True))


def assert_looks_as_it_should(client: httpx.Client, material: str, quality: str) -> None:
    response = client.post(query(quality), json=document(material))
    assert response.status_code == 200, response.text
    found = pixels(Image.open(io.BytesIO(response.content)))
    expected = pixels(Image.open(path(material, quality)))
    assert found.shape == expected.shape
    limit = NOISE_OF_GLASS if (material, quality) == ("glass", "final") else SEEN
    seen = {name: error for name, error in differences(expected, found).items() if error > limit}
    assert not seen


@pytest.mark.parametrize("material", MATERIALS)
def test_every_shape_looks_as_it_should_in_a_draft(client: httpx.Client, material: str) -> None:
    assert_looks_as_it_should(client, material, "draft")


# OpenGL has no part in final pictures: they are the same whatever it is drawn with.
@pytest.mark.parametrize("client", ["osmesa"], indirect=True)
@pytest.mark.parametrize("material", MATERIALS)
def test_every_shape_looks_as_it_should_when_final(client: httpx.Client, material: str) -> None:
    assert_looks_as_it_should(client, material, "final")


@pytest.mark.parametrize("quality", QUALITIES)
def test_the_measure_sees_another_material(quality: str) -> None:
    for one, other in ALIKE:
        pictures = [pixels(Image.open(path(material, quality))) for material in (one, other)]
        assert max(differences(*pictures).values()) > SEEN, (one, other)


def test_the_measure_sees_another_colour_and_another_shape() -> None:
    plastic = pixels(Image.open(path("plastic", "draft")))
    assert max(differences(plastic, plastic).values()) == 0
    other = pixels(Image.open(path("glass", "draft")))
    assert min(differences(plastic, other).values()) > SEEN
    swapped = np.roll(plastic, plastic.shape[1] // COLUMNS, axis=1)
    assert min(differences(plastic, swapped).values()) > SEEN


def test_the_measure_sees_another_shape_of_glass_and_glass_that_is_not_clear() -> None:
    glass = pixels(Image.open(path("glass", "final")))
    swapped = np.roll(glass, glass.shape[1] // COLUMNS, axis=1)
    assert min(differences(glass, swapped).values()) > NOISE_OF_GLASS
    dull = pixels(Image.open(path("plastic", "final")))
    assert min(differences(glass, dull).values()) > NOISE_OF_GLASS
