"""Routes of files: importing a garment, and exporting a document."""

from collections.abc import Mapping
from dataclasses import asdict, fields
from functools import partial
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path, Query, Request
from fastapi.concurrency import run_in_threadpool
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, Response

from app import searches
from app.api.answers import GarmentAnswer, Says
from app.api.asker import workspace_of
from app.api.body import read_bytes
from app.api.described import answering, problems
from app.api.disconnect import answer_of
from app.api.problems import ProblemResponse
from app.api.request_parsing import HasGarments
from app.document_state import DocumentState
from app.files.crease_reading import Creases
from app.files.export import DEFAULT_RATE_HZ, RATES_HZ, Export, Group, UnavailableFileError
from app.files.exports import EXPORTS, find_export
from app.files.graded_sizes import Graded
from app.files.import_errors import ImportedFileError, UnitsNeededError
from app.files.import_file import ENDINGS, SCALES, largest
from app.files.pieces import Pieces
from app.files.seam_allowance import Allowance, Line
from app.files.sketch_garment import Imported
from app.files.sketch_size import UNITS_M
from app.templates.catalogue import find_template
from app.worker.process import ignore
from app.worker.stop import Stop
from app.worker.workers import Workers
from planner.cloth.garment import Garment
from planner.errors import UnknownGarmentError

router = APIRouter(prefix="/api", tags=["files"])

_ANY_FILE = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}

_ENDING = "|".join("".join(f"[{letter.upper()}{letter}]" for letter in ending) for ending in ENDINGS)

FileName = Annotated[str, Query(max_length=300, json_schema_extra={"pattern": rf"[^/\\]\.({_ENDING})$"})]
Units = Annotated[
    str | None,
    Query(
        description="what one unit of the drawing is: mm, cm, m, in, pt (1/72 in) or px (1/96 in)",
        json_schema_extra={"anyOf": [{"enum": list(UNITS_M)}, {"type": "null"}]},
    ),
]
Scale = Annotated[float, Query(allow_inf_nan=False, json_schema_extra={"minimum": SCALES[0], "maximum": SCALES[1]})]
Lines = Annotated[
    Creases | None, Query(description="the cloth that fold lines are drawn on: as the folds before leave it, or flat")
]
Outlined = Annotated[
    Line | None,
    Query(description="the outline, where a seam line runs along inside a cut line; without it the seam line"),
]
Size = Annotated[
    str | None,
    Query(
        max_length=40,
        description="which of the sizes of a pattern that is graded, as M or 40; without it the sample size, or the "
        "middle one",
    ),
]
Piece = Annotated[
    str | None,
    Query(
        max_length=80,
        description="which of the pieces of a pattern, by its name or number as `pieces` lists them; without it the "
        "largest",
    ),
]
Measured = Annotated[
    str | None,
    Query(
        max_length=60,
        description="what gives the scale of a picture: a4, letter, marker:50mm, or a length of the garment, as "
        "0.60m:longest, 24in:width, 70cm:height; without it a sheet of A4 or Letter is looked for",
    ),
]
LikeName = Annotated[
    str | None,
    Query(
        max_length=80,
        description="what the garment in a picture is like, by the name of a template or a garment: its measures are "
        "fitted, and its folds come along",
    ),
]
What = Annotated[str, Path(json_schema_extra={"enum": [export.what for export in EXPORTS]})]
Rate = Annotated[float, Query(ge=RATES_HZ[0], le=RATES_HZ[1], allow_inf_nan=False)]


class ImportAnswer(BaseModel):
    """An imported garment, and notes about the import.

    `creases` says on which cloth the fold lines of a drawing were read; null if that makes no difference. `sizes`
    gives the width and height of the drawing in other units (m). `says` has the numbers of the notes, by name, null
    for a note without numbers. `seen` says of a picture where the garment lies in it, what gave the scale, and how sure
    that is, as `pleat see` does; null for other files. `allowance` is there for a drawing
    with a seam line inside a cut line, `graded` of one in several sizes, `pieces` of one with several pieces.
    """

    format: Literal["json", "fold", "svg", "dxf", "png", "jpeg"]
    garment: GarmentAnswer
    notes: list[str]
    says: list[Says | None]
    creases: Creases | None
    sizes: dict[str, tuple[float, float]] | None
    seen: dict[str, Any] | None
    allowance: Allowance | None
    graded: Graded | None
    pieces: Pieces | None


class FileEntry(BaseModel):
    """A kind of file that a document exports to; `reason` says why it is unavailable, `says` has the numbers.

    `group` is what it is for: to look at, for robots, or to be opened again. `is_slow` is true where it takes seconds.
    """

    what: str
    title: str
    text: str
    filename: str
    media_type: str
    group: Group
    is_slow: bool
    available: bool
    reason: str | None
    says: Says | None


@router.post("/imports", openapi_extra=_ANY_FILE, responses=answering(ImportAnswer, 413, 422, 503))
async def post_import(
    request: Request,
    filename: FileName,
    units: Units = None,
    scale: Scale = 1.0,
    creases: Lines = None,
    measured: Measured = None,
    like: LikeName = None,
    line: Outlined = None,
    size: Size = None,
    piece: Piece = None,
) -> Response:
    """Import a garment from a file in the body, by its name's ending: JSON, FOLD, SVG, DXF, PNG or JPEG.

    JSON is a garment file, a pattern specification of GarmentCode, or a plan file, which gives its garment, placed as
    at the plan's start.

    If the file has no unit of length, or an impossible one, the problem is about the field `units` and has `sizes`:
    the size of the garment in each unit. Unless `creases` says otherwise, fold lines are read on the cloth, flat or
    folded, on which more of them are legal. If nothing in a picture gives its scale, the problem is about the field
    `measured`. A pattern in several sizes, or with several pieces, gives one of them; the problem of a `size` or
    `piece` that it has not got lists them.
    """
    known = None if like is None else await run_in_threadpool(_liked, workspace_of(request), like)
    data = await read_bytes(request, largest(filename))
    lanes = workspace_of(request).lanes
    how = {"units": units, "scale": scale, "creases": creases, "measured": measured, "like": known}
    how |= {"line": line, "size": size, "piece": piece}
    work = partial(_read, lanes.workers, filename, data, how)
    try:
        return JSONResponse(_imported(await answer_of(request, lanes.files, work)))
    except UnitsNeededError as error:
        field = {"field": "units", "message": str(error), "says": error.why.to_dict()}
        return ProblemResponse(422, str(error), [field], None, {"sizes": error.sizes})


@router.get("/documents/{document_id}/files", responses=answering(list[FileEntry], 404, 422, 429))
async def list_files(request: Request, document_id: str) -> JSONResponse:
    """Return all kinds of files that a document can be exported as, and whether each is available now."""
    opened = await run_in_threadpool(workspace_of(request).opened, document_id)
    state = opened.document.state
    return JSONResponse([export.to_dict(state) for export in EXPORTS])


@router.get(
    "/documents/{document_id}/files/{what}",
    response_class=Response,
    responses={200: {"content": {export.media_type: {} for export in EXPORTS}}, **problems(404, 409, 422, 429, 503)},
)
async def read_file(request: Request, document_id: str, what: What, rate_hz: Rate = DEFAULT_RATE_HZ) -> Response:
    """Return a document as a file to save; `rate_hz` is the frame rate of a recording.

    Answers 409 with the reason if the document cannot be exported so now.
    """
    opened = await run_in_threadpool(workspace_of(request).opened, document_id)
    export, state = find_export(what), opened.document.state
    if export is None:
        raise HTTPException(404)
    work = partial(_made, export, state, rate_hz)
    try:
        with opened.in_use():
            made = await answer_of(request, workspace_of(request).lanes.files, work)
    except UnavailableFileError as error:
        return ProblemResponse(409, str(error))
    disposition = f'attachment; filename="{export.filename(state)}"'
    return Response(made, media_type=export.media_type, headers={"content-disposition": disposition})


def _read(workers: Workers, filename: str, data: bytes, how: Mapping[str, Any], stop: Stop) -> Imported:
    return workers.run_alone(searches.read_file, stop, ignore, filename, data, how)


def _liked(within: HasGarments, name: str) -> str | Garment:
    """Return the name of a template, or a garment; raise `ImportedFileError` if there is neither."""
    if find_template(name) is not None:
        return name
    try:
        return within.garments.garment(name)
    except UnknownGarmentError:
        raise ImportedFileError("like", f"there is no template and no garment {name!r}") from None


def _made(export: Export, state: DocumentState, rate_hz: float, should_stop: Stop) -> bytes:
    return export.file(state, rate_hz, should_stop)


def _imported(imported: Imported) -> dict[str, Any]:
    answer = {field.name: getattr(imported, field.name) for field in fields(imported)}
    parts = {name: asdict(part) for name in ("allowance", "graded", "pieces") if (part := answer[name]) is not None}
    notes = {"notes": [note.text for note in imported.notes], "says": [note.to_dict() for note in imported.notes]}
    return {**answer, **parts, **notes, "garment": imported.garment.to_dict()}
