"""A typed client of Tubeloom, the service that draws hyperedges as smooth tubes."""

from tubeloom_client.client import Client
from tubeloom_client.job import Job
from tubeloom_client.layouts import Layout
from tubeloom_client.options import Document, Format, RenderOptions
from tubeloom_client.problems import (
    Busy,
    Fault,
    JobCancelled,
    JobFailed,
    LostRace,
    NotAllowed,
    NotFound,
    Problem,
    TubeloomError,
    Unreachable,
)
from tubeloom_client.program import Program
from tubeloom_client.records import (
    Changes,
    Current,
    Deleted,
    Happening,
    JobState,
    Listed,
    Reset,
    Revision,
    Sets,
)

__all__ = [
    "Busy",
    "Changes",
    "Client",
    "Current",
    "Deleted",
    "Document",
    "Fault",
    "Format",
    "Happening",
    "Job",
    "JobCancelled",
    "JobFailed",
    "JobState",
    "Layout",
    "Listed",
    "LostRace",
    "NotAllowed",
    "NotFound",
    "Problem",
    "Program",
    "RenderOptions",
    "Reset",
    "Revision",
    "Sets",
    "TubeloomError",
    "Unreachable",
]
