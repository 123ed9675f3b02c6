"""Routes of robots: the list, and one robot's card."""

from typing import Any

from fastapi import APIRouter
from fastapi.concurrency import run_in_threadpool
from starlette.responses import JSONResponse

from app.api.answers import RobotEntry
from app.api.described import DescribedRoute, problems
from planner.robots.card_file import CardFile
from planner.robots.described_robot import robot_entry, shipped_card, shipped_robots

router = APIRouter(prefix="/api/robots", tags=["robots"], route_class=DescribedRoute)


@router.get("", response_model=list[RobotEntry])
async def list_robots() -> list[dict[str, Any]]:
    """Return all robots that are described, in alphabetical order."""
    cards = await run_in_threadpool(lambda: [shipped_card(name) for name in shipped_robots()])
    return [robot_entry(card) for card in cards]


@router.get("/{name}", responses={200: {"model": CardFile}, **problems(404)})
async def read_robot_card(name: str) -> JSONResponse:
    """Return a robot's card with every field filled in."""
    card = await run_in_threadpool(shipped_card, name)
    return JSONResponse(card.to_dict())
