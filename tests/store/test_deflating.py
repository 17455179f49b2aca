"""What is stored comes back as it was, whatever is known of it still."""

from __future__ import annotations

import zlib
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.store.deflating import LARGEST_KNOWN, MOST_KNOWN, Deflater


@given(st.lists(st.binary(max_size=50), max_size=3 * MOST_KNOWN))
def test_everything_comes_back(texts: list[bytes]) -> None:
    deflater = Deflater()
    deflated = [deflater.deflate(text) for text in texts]
    assert [zlib.decompress(each) for each in deflated] == texts
    assert [deflater.inflate(each) for each in deflated] == texts
    assert [Deflater().inflate(each) for each in deflated] == texts


def test_what_was_deflated_last_is_the_same_object() -> None:
    deflater = Deflater()
    document = b"a document" * 100
    deflated = deflater.deflate(document)
    assert deflater.inflate(bytes(bytearray(deflated))) is document
    for number in range(MOST_KNOWN):
        deflater.deflate(str(number).encode())
    assert deflater.inflate(deflated) is not document


def test_what_is_large_is_not_known() -> None:
    deflater = Deflater()
    document = bytes(LARGEST_KNOWN + 1)
    deflated = deflater.deflate(document)
    assert deflater.inflate(deflated) == document
    assert deflater.inflate(deflated) is not document


def test_other_bytes_are_no_document() -> None:
    with pytest.raises(zlib.error):
        Deflater().inflate(b"no document")


def test_many_may_ask_at_once() -> None:
    deflater = Deflater()
    texts = [str(number).encode() * 1000 for number in range(3 * MOST_KNOWN)]
    deflated = [deflater.deflate(text) for text in texts]
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(deflater.inflate, deflated * 20)) == texts * 20
