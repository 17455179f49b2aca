"""Every setting and every limit, in one place; environment variables with the prefix TUBELOOM_."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Literal

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict


class Settings(BaseSettings):
    """How this process behaves and what it refuses."""

    model_config = SettingsConfigDict(env_prefix="TUBELOOM_", frozen=True, extra="forbid")

    host: str = "127.0.0.1"
    port: int = Field(8000, ge=0, le=65535)
    workers: int = Field(2, ge=1, le=256, description="Processes that do the work.")
    gl_platform: Literal["auto", "osmesa", "egl"] = Field(
        "auto", description="What the draft renderer draws with."
    )
    log_format: Literal["console", "json"] = "console"

    data_folder: Path = Field(
        Path(".tubeloom"), description="Where programs, jobs and results are kept by default."
    )
    database: str | None = Field(
        None,
        description="postgresql://… or sqlite:///…; left out, SQLite in the data folder.",
    )

    max_body_bytes: int = Field(32 * 1024 * 1024, ge=1)
    max_waiting: int = Field(64, ge=0, description="Requests that may wait for a worker.")
    deadline_seconds: float = Field(60.0, gt=0, description="Longest work on one request.")

    max_worker_bytes: int = Field(
        4 * 1024**3, ge=512 * 1024**2, description="Memory that one worker may take."
    )
    max_values: int = Field(
        2_000_000, ge=1, description="JSON values in one document, counted by commas."
    )
    max_items: int = Field(20_000, ge=1)
    max_hyperedges: int = Field(100_000, ge=1)
    max_attachments: int = Field(400_000, ge=2, description="Over all hyperedges together.")
    max_depth: int = Field(64, ge=1, description="Items within items.")
    max_label_characters: int = Field(
        100_000, ge=1, description="Over all labels that are drawn together."
    )
    max_csg_nodes: int = Field(
        1_000, ge=1, description="Over all trees of constructive solid geometry together."
    )
    max_csg_depth: int = Field(64, ge=1, le=90, description="Of one such tree.")
    max_pixels: int = Field(4096 * 4096, ge=1)
    max_film_pixels: int = Field(
        400_000_000, ge=1, description="Over all frames of an animation together."
    )
    max_print_triangles: int = Field(
        2_000_000, ge=1, description="Of what a print is made from, before tubes are united."
    )

    @property
    def database_url(self) -> str:
        """Of the database, with its default."""
        return self.database or f"sqlite:///{self.data_folder.resolve() / 'tubeloom.db'}"


@lru_cache(maxsize=1)
def settings() -> Settings:
    """The settings of this process, read from the environment once."""
    return Settings()
