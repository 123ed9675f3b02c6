"""The page at `/` and its files."""

from fastapi import APIRouter, FastAPI
from starlette.responses import FileResponse, Response
from starlette.staticfiles import StaticFiles

from app.resources import static_dir

router = APIRouter(include_in_schema=False)

_FRESH = {"cache-control": "no-cache"}


@router.get("/")
async def read_page() -> Response:
    """The designer."""
    return FileResponse(static_dir() / "index.html", headers=_FRESH)


class FreshFiles(StaticFiles):
    """Files that a browser asks about again each time: after an update it shall not mix old and new."""

    def file_response(self, *args: object, **kwargs: object) -> Response:
        """As usual, and not to be kept without asking."""
        response: Response = super().file_response(*args, **kwargs)  # type: ignore[arg-type]
        response.headers.update(_FRESH)
        return response


def mount_files(app: FastAPI) -> None:
    """Serve the page's scripts and styles at `/static`."""
    app.mount("/static", FreshFiles(directory=static_dir()), name="static")
