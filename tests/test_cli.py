from __future__ import annotations

import json
import os
import pty
import struct
import subprocess
import sys
import termios
import threading
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from app import __version__
from app.cli import main
from app.output.stl import RECORD
from tests.children import SCRIPT_SECONDS
from tests.service import PATIENCE_SECONDS, SMALL, large_program


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "program.json"
    path.write_text(json.dumps(SMALL))
    return path


@pytest.mark.parametrize(
    ("name", "start"),
    [
        ("out.glb", b"glTF"),
        ("out.gltf", b"{"),
        ("out.PNG", b"\x89PNG"),
        ("out.stl", b"Binary STL"),
        ("out.3mf", b"PK"),
    ],
)
def test_the_ending_of_the_output_tells_the_format(program: Path, name: str, start: bytes) -> None:
    output = program.with_name(name)
    done = CliRunner().invoke(main, ["render", str(program), "-o", str(output)])
    assert done.exit_code == 0, done.output
    assert output.read_bytes().startswith(start)


def test_gltf_is_compressed_and_merged_as_asked(program: Path) -> None:
    output = program.with_name("out.glb")
    arguments = ["render", str(program), "-o", str(output), "--compress", "meshopt", "--merge"]
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 0, done.output
    assert b'"EXT_meshopt_compression"' in output.read_bytes()
    assert b'"hyperedges 0"' in output.read_bytes()


def test_a_picture_has_the_size_that_was_asked_for(program: Path) -> None:
    output = program.with_name("out.png")
    arguments = ["render", str(program), "-o", str(output), "--width", "320", "--height", "200"]
    assert CliRunner().invoke(main, arguments).exit_code == 0
    assert struct.unpack(">II", output.read_bytes()[16:24]) == (320, 200)


def test_a_print_has_the_scale_and_the_parts_that_were_asked_for(program: Path) -> None:
    sizes = []
    for arguments in ([], ["--parts", "hyperedges"], ["--scale", "1000"]):
        output = program.with_name("out.stl")
        done = CliRunner().invoke(main, ["render", str(program), "-o", str(output), *arguments])
        assert done.exit_code == 0, done.output
        corners = np.frombuffer(output.read_bytes(), RECORD, offset=84)["corners"]
        sizes.append((len(corners), float(corners.max())))
    assert sizes[1][0] < sizes[0][0] == sizes[2][0]
    assert sizes[2][1] == pytest.approx(100 * sizes[0][1], rel=1e-5)


def test_documents_come_and_answers_go_through_pipes() -> None:
    done = CliRunner().invoke(main, ["render", "-", "--format", "glb"], input=json.dumps(SMALL))
    assert done.exit_code == 0
    assert done.stdout_bytes.startswith(b"glTF")


def test_layout_writes_numbers(program: Path) -> None:
    done = CliRunner().invoke(main, ["layout", str(program), "--patches"])
    assert done.exit_code == 0, done.output
    numbers = json.loads(done.stdout)
    segments = numbers["hyperedges"][0]["segments"]
    assert len(segments) >= 3
    assert all(segment["patches"] for segment in segments)


def test_convert_writes_a_program(tmp_path: Path) -> None:
    netlist = tmp_path / "netlist.json"
    port = {"direction": "input", "bits": [2]}
    netlist.write_text(json.dumps({"modules": {"top": {"ports": {"a": port}, "cells": {}}}}))
    output = tmp_path / "program.json"
    done = CliRunner().invoke(main, ["convert", str(netlist), "--from", "yosys", "-o", str(output)])
    assert done.exit_code == 0, done.output
    assert json.loads(output.read_text())["items"]


def test_every_fault_of_a_document_is_a_line_with_its_place(tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_text('{"items": [{"id": ""}, {"id": "b", "color": "red"}]}')
    done = CliRunner().invoke(main, ["render", str(path), "-o", str(tmp_path / "out.glb")])
    assert done.exit_code == 1
    places = [line.split(": ")[1] for line in done.stderr.splitlines()]
    assert places == ["/items/0/id", "/items/1/color"]
    assert not (tmp_path / "out.glb").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ["render", "nowhere.json", "-o", "out.glb"],
        ["render", "-", "-o", "out.gif"],
        ["render", "-"],
        ["convert", "-", "--from", "verilog"],
        ["serve", "--port", "123456"],
        ["paint"],
    ],
)
def test_wrong_use_is_explained(arguments: list[str]) -> None:
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 2
    assert "Usage" in done.stderr


def test_an_output_that_cannot_be_written_is_an_error_of_one_line(program: Path) -> None:
    output = program.parent / "nowhere" / "out.glb"
    done = CliRunner().invoke(main, ["render", str(program), "-o", str(output)])
    assert done.exit_code == 1
    assert "Traceback" not in done.output
    assert str(output) in done.stderr


def test_openapi_writes_the_interface() -> None:
    done = CliRunner().invoke(main, ["openapi"])
    assert json.loads(done.stdout)["info"]["version"] == __version__


def standard_error_of(arguments: list[str], folder: Path) -> str:
    """What a terminal would show."""
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24, 80))
    process = subprocess.Popen([sys.executable, "-m", "app", *arguments], stderr=theirs, cwd=folder)
    os.close(theirs)
    shown = b""
    stopping = threading.Timer(SCRIPT_SECONDS, process.kill)
    stopping.start()
    with os.fdopen(ours, "rb", buffering=0) as terminal:
        try:
            while piece := terminal.read(4096):
                shown += piece
        except OSError:  # Linux says so that nobody writes to the terminal any more
            pass
    stopping.cancel()
    assert process.wait(PATIENCE_SECONDS) == 0, shown
    return shown.decode()


def test_long_work_shows_a_bar_and_short_work_does_not(program: Path) -> None:
    large = program.with_name("large.json")
    large.write_bytes(large_program(600))
    folder = program.parent
    assert "%" in standard_error_of(["render", str(large), "-o", "large.glb"], folder)
    assert "%" not in standard_error_of(["convert", str(program), "-o", "small.json"], folder)
