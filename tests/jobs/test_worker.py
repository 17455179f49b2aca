import json

from app.answers import Answer, RenderOptions, Unchanged
from app.errors import PictureTooLarge
from app.jobs.work import Crash, Work
from app.jobs.worker import WARM_UP, do
from app.output.media import SceneFormat
from app.settings import Settings
from tests.service import SMALL

DOCUMENT = json.dumps(SMALL).encode()


def test_an_answer_comes_with_its_body_apart() -> None:
    reply, body = do(Work(RenderOptions(SceneFormat.GLTF)), DOCUMENT, Settings())
    assert isinstance(reply.outcome, Answer)
    assert reply.outcome.body == b""
    assert json.loads(body)["asset"]["version"] == "2.0"


def test_the_stages_of_the_work_are_timed_in_order() -> None:
    reply, _ = do(Work(RenderOptions()), DOCUMENT, Settings())
    names = [stage.name for stage in reply.stages]
    assert names[0] == "reading"
    assert names[-1] == "writing"
    assert all(stage.seconds >= 0 for stage in reply.stages)


def test_what_is_known_is_not_made_again() -> None:
    first, _ = do(Work(RenderOptions()), DOCUMENT, Settings())
    assert isinstance(first.outcome, Answer)
    assert first.outcome.etag
    known = frozenset({first.outcome.etag})
    reply, body = do(Work(RenderOptions(), known), DOCUMENT, Settings())
    assert (reply.outcome, body) == (Unchanged(first.outcome.etag), b"")


def test_what_is_refused_before_the_first_stage_is_refused_all_the_same() -> None:
    reply, _ = do(Work(RenderOptions(width=99_999, height=99_999)), DOCUMENT, Settings())
    assert isinstance(reply.outcome, PictureTooLarge)
    assert reply.stages == ()


def test_an_error_that_nobody_foresaw_is_carried_as_its_traceback() -> None:
    reply, _ = do(Work(RenderOptions(source="no such format")), DOCUMENT, Settings())
    assert isinstance(reply.outcome, Crash | Exception)


def test_the_warm_up_takes_every_kernel_through_its_first_call() -> None:
    reply, body = do(Work(RenderOptions()), WARM_UP, Settings())
    assert isinstance(reply.outcome, Answer)
    assert body.startswith(b"glTF")
