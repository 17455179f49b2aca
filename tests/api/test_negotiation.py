import pytest

from app.api.negotiation import choose, media_type_of, parse_accept
from app.api.problems import NotAcceptableError

OFFERS = {"model/gltf-binary": "glb", "model/gltf+json": "gltf", "image/png": "png"}


@pytest.mark.parametrize(
    ("accept", "chosen"),
    [
        (None, "glb"),
        ("", "glb"),
        ("*/*", "glb"),
        ("image/png", "png"),
        ("IMAGE/PNG", "png"),
        ("image/*", "png"),
        ("model/*", "glb"),
        ("model/gltf+json, */*", "glb"),
        ("model/gltf+json, */*;q=0.9", "gltf"),
        ("image/png;q=0.5, model/gltf+json;q=0.8", "gltf"),
        ("model/*;q=0.5, model/gltf-binary;q=0.1", "gltf"),
        ("model/gltf-binary;q=0, */*", "gltf"),
        ("image/png;level=1;q=0.4, model/gltf+json;q=0.3", "png"),
        ("text/html,application/xhtml+xml,image/avif,*/*;q=0.8", "glb"),
        ("nonsense, image/png", "png"),
        ("image/png;q=high, model/gltf+json;q=0.1", "gltf"),
    ],
)
def test_the_format_that_is_liked_best_is_chosen(accept: str | None, chosen: str) -> None:
    assert choose(accept, OFFERS) == chosen


@pytest.mark.parametrize("accept", ["text/html", "image/png;q=0", "*/*;q=0", "nonsense", ","])
def test_where_nothing_fits_nothing_is_chosen(accept: str) -> None:
    with pytest.raises(NotAcceptableError, match="model/gltf-binary"):
        choose(accept, OFFERS)


def test_ranges_keep_their_quality() -> None:
    assert [found.quality for found in parse_accept("a/b;q=0.25, c/d , e/f;q=1.5")] == [0.25, 1.0]


def test_a_media_type_is_read_without_its_parameters() -> None:
    assert media_type_of("Application/JSON ; charset=utf-8") == "application/json"
