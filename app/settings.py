"""Every setting and every limit, in one place; environment variables with the prefix TUBELOOM_."""

from __future__ import annotations

import ipaddress
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict


def _parted(value: Any) -> Any:
    """What stands between commas, where it comes as one text."""
    if isinstance(value, str):
        return tuple(part.strip() for part in value.split(",") if part.strip())
    return value


def _rate(value: str) -> str:
    """A rate that can be kept. Raises `ValueError`."""
    from limits import parse_many

    parse_many(value)
    return value


Rate = Annotated[str, AfterValidator(_rate)]
Names = Annotated[tuple[str, ...], NoDecode, BeforeValidator(_parted)]


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
    results: str | None = Field(
        None,
        description="Where results are kept: s3://…, gs://…, az://…, a folder or file://…, or "
        "memory://; left out, in the data folder.",
    )
    results_bytes: int = Field(
        1024**3, ge=0, description="Of all results that are kept; the least used go first."
    )
    memory_bytes: int = Field(
        64 * 1024**2, ge=0, description="Of results that are kept at hand in memory besides."
    )

    auth: Literal["auto", "required", "off"] = Field(
        "auto", description="Whether keys are needed; auto: unless only this machine is served."
    )
    key_seconds: float = Field(
        5.0, gt=0, description="So long may a key that was revoked meanwhile still be taken."
    )
    rate_per_key: Rate | None = Field(
        None, description="Most requests with one key, such as 20/second; 600/minute."
    )
    rate_per_address: Rate | None = Field(
        None, description="Most requests from one address, where they come without a key."
    )
    budget_seconds: float | None = Field(
        None, gt=0, description="Work done for one key or address in a minute, in seconds."
    )
    cors_origins: Names = Field(
        (), description="Origins whose pages may call, with commas between them, or *."
    )
    hosts: Names = Field(
        (),
        description="Host names that are answered to; left out, all where keys are needed, and "
        "those of this machine where they are not.",
    )
    trusted_proxies: Names = Field(
        (), description="Addresses of proxies whose X-Forwarded-For is believed."
    )
    traces: str | None = Field(
        None, description="URL of an OpenTelemetry collector (OTLP over HTTP) that gets spans."
    )

    require_if_match: bool = Field(
        False, description="Whether changes of stored programs must say which revision they change."
    )
    kept_revisions: int = Field(
        100, ge=2, description="Of each stored program; older ones cannot be restored."
    )
    max_programs: int = Field(100_000, ge=0, description="That are stored.")
    max_watchers: int = Field(
        5_000, ge=0, description="Of events, of stored programs, jobs and renders together."
    )
    look_seconds: float = Field(
        0.5,
        ge=0.05,
        description="How often a watched program is looked up, lest another service changed it.",
    )

    job_workers: int = Field(1, ge=1, le=256, description="Processes that work on jobs.")
    job_deadline_seconds: float = Field(600.0, gt=0, description="Longest work on one job.")
    job_attempts: int = Field(
        3, ge=1, description="So often is a work begun whose process dies over it."
    )
    job_lease_seconds: float = Field(
        12.0,
        ge=2,
        description="So long are jobs of a service that was killed left to it, lest it still live.",
    )
    job_result_hours: float = Field(24.0, gt=0, description="What a job made is kept so long.")
    max_jobs_waiting: int = Field(1_000, ge=0, description="Jobs that nobody works on yet.")
    dask_scheduler: str = Field(
        "", description="tcp://… of a Dask scheduler, whose workers then do the jobs."
    )

    max_body_bytes: int = Field(32 * 1024 * 1024, ge=1)
    max_held_bytes: int = Field(
        512 * 1024 * 1024, ge=1, description="Of all bodies that are read or worked on at a time."
    )
    upload_seconds: float = Field(60.0, gt=0, description="Longest that a body may take to come.")
    max_unread_bytes: int = Field(
        512 * 1024 * 1024,
        ge=1,
        description="Of all answers that wait until their clients read them.",
    )
    write_seconds: float = Field(
        30.0,
        gt=0,
        description="After which a connection is closed whose client does not read its answer.",
    )
    head_seconds: float = Field(
        10.0,
        gt=0,
        description="Longest that the head of a request may take to come, or the rest of a body "
        "that nobody reads.",
    )
    max_waiting: int = Field(64, ge=0, description="Requests that may wait for a worker.")
    deadline_seconds: float = Field(60.0, gt=0, description="Longest work on one request.")
    layout_share: float = Field(
        0.5,
        ge=0,
        le=1,
        description="Of the longest work, after which a layout is answered as it is.",
    )
    certificate_share: float = Field(
        0.75,
        ge=0,
        le=1,
        description="Of the longest work, after which no more conflicts are looked for.",
    )
    examine_seconds: float = Field(
        5.0,
        gt=0,
        description="So long is believed what /readyz tried out, and longer it may not take.",
    )

    max_worker_bytes: int = Field(
        4 * 1024**3, ge=512 * 1024**2, description="Memory that one worker may take."
    )
    kept_worker_bytes: int = Field(
        1024**3,
        ge=0,
        description="A worker that holds more than this after a work is replaced by a new one.",
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
    def is_local(self) -> bool:
        """Whether only this machine can reach the service."""
        try:
            return ipaddress.ip_address(self.host).is_loopback
        except ValueError:
            return self.host == "localhost"

    @property
    def needs_keys(self) -> bool:
        """Whether requests must come with a key."""
        return self.auth == "required" or (self.auth == "auto" and not self.is_local)

    @property
    def database_url(self) -> str:
        """Of the database, with its default."""
        return self.database or f"sqlite:///{self.data_folder.resolve() / 'tubeloom.db'}"

    @property
    def results_place(self) -> str:
        """Folder or URL of results, with its default."""
        return self.results or str(self.data_folder.resolve() / "results")


@lru_cache(maxsize=1)
def settings() -> Settings:
    """The settings of this process, read from the environment once."""
    return Settings()
