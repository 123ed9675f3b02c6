"""Routes of garments: the list, one, and saving one's own."""

from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request, Response
from fastapi.concurrency import run_in_threadpool
from starlette.responses import JSONResponse

from app.api.asker import workspace_of
from app.api.body import JsonBody
from app.api.described import DescribedRoute, answering, problems
from app.api.messages import WholeGarment
from app.store.garment_repository import GarmentEntry
from planner.cloth.garment import Garment
from planner.errors import GarmentError

router = APIRouter(prefix="/api/garments", tags=["garments"], route_class=DescribedRoute)

_TOWEL = {
    "name": "my-towel",
    "outline": [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]],
    "folds": [{"name": "half", "kind": "blue", "start": [0.4, 0.15], "end": [0.0, 0.15]}],
}
AnyName = Annotated[str, Path(examples=["t-shirt"])]
OwnName = Annotated[str, Path(examples=[_TOWEL["name"]])]
GarmentBody = Annotated[Garment, Depends(JsonBody(WholeGarment, _TOWEL))]


@router.get("")
async def list_garments(request: Request) -> list[GarmentEntry]:
    """Return all garments, the shipped ones first."""
    return await run_in_threadpool(workspace_of(request).garments.entries)


@router.get("/{name}", responses=answering(Garment, 404))
async def read_garment(request: Request, name: AnyName) -> JSONResponse:
    """Return a garment file with every field filled in."""
    garment = await run_in_threadpool(workspace_of(request).garments.garment, name)
    return JSONResponse(garment.to_dict())


@router.put(
    "/{name}", responses={200: {"model": Garment}, 201: {"model": Garment}, **problems(403, 409, 413, 422, 507)}
)
async def save_garment(request: Request, name: OwnName, garment: GarmentBody) -> JSONResponse:
    """Save or replace a garment of one's own: 201 if it is new, 200 if it existed."""
    repository = workspace_of(request).garments
    if garment.name != name:
        raise GarmentError("name", f"is {garment.name!r}, but the address says {name!r}")
    is_new = await run_in_threadpool(repository.save, garment)
    return JSONResponse(garment.to_dict(), status_code=201 if is_new else 200)


@router.delete("/{name}", status_code=204, responses=problems(403, 404, 409))
async def remove_garment(request: Request, name: OwnName) -> Response:
    """Remove a garment of one's own."""
    await run_in_threadpool(workspace_of(request).garments.remove, name)
    return Response(status_code=204)
