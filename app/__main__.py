"""``python -m app`` is ``tubeloom``."""

from app.cli import main

main(prog_name="tubeloom")
