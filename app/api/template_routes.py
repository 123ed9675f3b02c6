"""Routes of templates: kinds of garments that are made from a few measures."""

from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Request
from fastapi.concurrency import run_in_threadpool
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse

from app.api.answers import GarmentAnswer, Point
from app.api.body import JsonBody
from app.api.described import DescribedRoute, answering
from app.store.picture import PictureFold
from app.templates.catalogue import TEMPLATES, find_template
from app.templates.measure import MeasureError, Measures
from planner.cloth.garment import TITLE_MAX
from planner.strict_model import StrictModel

router = APIRouter(prefix="/api/templates", tags=["templates"], route_class=DescribedRoute)


class MeasureAnswer(BaseModel):
    """A measure of a template (m)."""

    name: str
    label: str
    text: str
    default_m: float
    min_m: float
    max_m: float


class TemplateAnswer(BaseModel):
    """A template, and the garment that it makes of its defaults (m)."""

    name: str
    title: str
    text: str
    measures: list[MeasureAnswer]
    outline: list[Point]
    folds: list[PictureFold]


class MadeAnswer(BaseModel):
    """The garment that a template has made, and its measures (m)."""

    garment: GarmentAnswer
    measures: dict[str, float]
    notes: list[str]


class MadeRequest(StrictModel):
    """Measures (m) and a name; measures left out are scaled in proportion to the others or have their defaults."""

    measures: dict[str, float] = Field(default_factory=dict)
    title: Annotated[str, Field(max_length=TITLE_MAX)] | None = None


Name = Annotated[str, Path(examples=[TEMPLATES[0].name])]
MadeRequestBody = Annotated[MadeRequest, Depends(JsonBody(MadeRequest, {"title": "A towel"}, may_be_empty=True))]


@router.get("", response_model=list[TemplateAnswer])
async def list_templates() -> list[dict[str, Any]]:
    """Return all templates, in the order in which to show them."""
    return await run_in_threadpool(lambda: [template.to_dict() for template in TEMPLATES])


@router.post("/{name}", responses=answering(MadeAnswer, 404, 413, 422))
async def post_template(request: Request, name: Name, wanted: MadeRequestBody) -> JSONResponse:
    """Return the garment that a template makes of these measures, with its folds."""
    template = find_template(name)
    if template is None:
        raise HTTPException(404)
    try:
        measures = Measures(template.measures, wanted.measures)
        garment = await run_in_threadpool(template.made, measures, wanted.title)
    except MeasureError as error:
        raise error.within("measures") from None
    return JSONResponse({"garment": garment.to_dict(), "measures": measures.to_dict(), "notes": []})
