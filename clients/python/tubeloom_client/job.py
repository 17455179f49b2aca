"""A job, for a client that waits for each answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from tubeloom_client import calls
from tubeloom_client.problems import JobCancelled, JobFailed
from tubeloom_client.records import JobState, job_after

if TYPE_CHECKING:
    from tubeloom_client.client import Client


class Job:
    """The job called ``id``."""

    def __init__(self, client: Client, identifier: str) -> None:
        self._client = client
        self.id = identifier

    def state(self) -> JobState:
        """How far it is."""
        return self._client.send(calls.job(self.id))

    def follow(self) -> Iterator[JobState]:
        """How it goes on, until it is over; goes on by itself where the connection breaks."""
        state = self.state()
        yield state
        if state.is_over:
            return
        for event in self._client.events(calls.followed(self.id)):
            state = job_after(state, event)
            yield state
            if state.is_over:
                return

    def wait(self, progress: Callable[[JobState], None] | None = None) -> bytes:
        """What it makes, once it is done; ``progress`` hears how it goes on.

        Raises `JobFailed` or `JobCancelled`.
        """
        for state in self.follow():
            if progress is not None:
                progress(state)
            if state.state == "cancelled":
                raise JobCancelled(f"Job {self.id} has been cancelled.")
            if state.state == "failed":
                raise JobFailed(state.problem or {})
        return self.result()

    def result(self) -> bytes:
        """What it has made. Raises `Problem` while it is not done."""
        return self._client.send(calls.result(self.id))

    def cancel(self) -> None:
        """End it, and free what it works with."""
        self._client.send(calls.cancel(self.id))
