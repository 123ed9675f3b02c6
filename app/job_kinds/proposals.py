"""Proposals as a job: ways to fold a garment to a size, each planned."""

import uuid
from collections.abc import Callable, Generator
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, NamedTuple, get_args

from pydantic import Field, PlainValidator
from pydantic_core import PydanticCustomError

from app.api.messages import GarmentField, TimeLimit
from app.api.request_parsing import requested_garment
from app.jobs.job_kind import JobKind, Progress, Stores, as_it_is
from app.store.packed_plan import PackedPlan
from planner.cloth.garment import FOLDS_MAX, Garment
from planner.geometry.given import GivenPose
from planner.json_form import JsonForm
from planner.planning.robot_task import with_robots_scene
from planner.proposals.proposals import (
    COUNT_MAX,
    WORK_LIMIT_S,
    Face,
    Proposal,
    ProposalOptions,
    Tried,
    all_proposals,
    propose_folds,
)
from planner.proposals.target import SIDE_MAX_M, SIDE_MIN_M, Target
from planner.robots.known_robots import require_name
from planner.strict_model import StrictModel
from planner.task.scene import Scene
from planner.task.task import COMFORT_MAX_M, DEFAULT_ROBOT, Task

Side = Annotated[float, Field(ge=SIDE_MIN_M, le=SIDE_MAX_M)]


class SizeField(StrictModel):
    """The sides of a target (m)."""

    width_m: Side
    length_m: Side


class LikeField(StrictModel):
    """A garment whose folds are to be fitted."""

    like: GarmentField


_SIZES, _LIKE = JsonForm(SizeField), JsonForm(LikeField)


def _to(value: Any) -> str | SizeField | LikeField:  # noqa: ANN401
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        return _LIKE.read(value) if "like" in value else _SIZES.read(value)
    raise PydanticCustomError(
        "size_type", "should be a size's name, or an object with width_m and length_m, or with a garment as like"
    )


To = str | SizeField | LikeField


class ProposalsRequest(StrictModel):
    """A request for ways to fold a garment to a size, or like another one; only `garment` and `to` are required."""

    garment: GarmentField
    to: Annotated[To, PlainValidator(_to, json_schema_input_type=To)]
    robot: str = DEFAULT_ROBOT
    count: Annotated[int, Field(ge=1, le=COUNT_MAX)] = 6
    untried: Annotated[int, Field(ge=0, le=COUNT_MAX)] = 0
    max_folds: Annotated[int, Field(ge=1, le=FOLDS_MAX)] = 8
    face: Annotated[str, Field(json_schema_extra={"enum": list(get_args(Face))})] = "any"
    scene: Scene | None = None
    placement: GivenPose | None = None
    start_station: str | None = None
    comfort_radius_m: Annotated[float, Field(ge=0.0, le=COMFORT_MAX_M)] = 0.03
    work_limit_s: TimeLimit = WORK_LIMIT_S

    @staticmethod
    def completed(data: object) -> object:
        """Return a request's JSON with a scene that is given in part filled up by that of the robot."""
        return with_robots_scene(data)


class ProposalsTask(NamedTuple):
    """What proposals are asked for: the garment, how many, and what begins to look for them as they are taken."""

    garment: Garment
    most: int
    begin: Callable[[], Generator[Proposal, None, Tried]]


def _prepare(stores: Stores, wanted: ProposalsRequest) -> ProposalsTask:
    require_name(wanted.robot)
    options = ProposalOptions(placement=wanted.placement, comfort_radius_m=wanted.comfort_radius_m)
    if wanted.start_station is not None:
        options["start_station"] = wanted.start_station
    garment = requested_garment(stores, wanted.garment)
    same = ("robot", "count", "untried", "max_folds", "face", "scene", "work_limit_s")
    asked: dict[str, Any] = {name: getattr(wanted, name) for name in same}
    begin = partial(propose_folds, garment, _target(stores, wanted.to), **asked, **options)
    begin()  # checks the rest
    return ProposalsTask(garment, wanted.count, begin)


def _target(stores: Stores, to: To) -> Target | Garment:
    if isinstance(to, LikeField):
        return requested_garment(stores, to.like)
    return Target.of(to if isinstance(to, str) else (to.width_m, to.length_m))


@dataclass(frozen=True, slots=True)
class Found:
    """A proposal as JSON with the id of its plan, if it has one, and the plan, packed in the job's process.

    Attributes:
        body: the proposal.
        plan: its plan and the task that it is one for; None if it was not planned.
    """

    body: dict[str, Any]
    plan: tuple[Task, PackedPlan] | None


def propose(asked: ProposalsTask, progress: Progress) -> dict[str, Any]:
    """Return the proposals as JSON, telling each as it is found; the work of the job."""
    bodies: dict[int, dict[str, Any]] = {}

    def hear(proposal: Proposal) -> None:
        if proposal.plan is None:
            progress(0.0, "", Found(proposal.to_dict(), None))
            return
        body = {**proposal.to_dict(), "plan_id": uuid.uuid4().hex}
        if proposal.number:
            bodies[proposal.number] = body
        progress(
            len(bodies) / asked.most,
            f"{len(bodies)} found",
            Found(body, (proposal.plan.task, PackedPlan.of(proposal.plan))),
        )

    found = all_proposals(asked.begin(), hear)
    return {**found.to_dict(), "proposals": [bodies[one.number] for one in found.proposals]}


def _tell(stores: Stores, found: Found) -> dict[str, Any]:
    """Store the plan of a proposal, if it has one, and return the proposal as JSON."""
    if found.plan is not None:
        task, packed = found.plan
        stores.plans.add_packed(packed, found.body["plan_id"])
        stores.plans.answers.propose(task, packed)
    return found.body


PROPOSALS = JobKind(
    name="proposals",
    does="Propose folds that bring a garment to a size, or fold it like another, each planned for a robot, as a job.",
    body=ProposalsRequest,
    example={"garment": "hand-towel", "to": {"width_m": 0.25, "length_m": 0.3}, "count": 2},
    prepare=_prepare,
    work=propose,
    finish=as_it_is,
    tell=_tell,
    about=lambda asked: asked.garment.title,
    path="/api/proposals",
    may_begin_anew=True,
    is_listed_cancelled=False,
)
