"""The pictures of the documents are taken from the page, and those that are there are shown."""

import io

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page

from docs.pictures import take
from tests.app.conftest import Served
from tests.test_deploy import ROOT

LARGEST = 2_000_000
"""The largest picture that a reader should have to wait for (bytes)."""


@pytest.mark.long
def test_a_picture_shows_the_page(page: Page, designer: Served) -> None:
    take.PICTURES["exported"](page, designer.url)
    with Image.open(io.BytesIO(take.still(page))) as picture:
        assert picture.format == "WEBP"
        assert picture.size == (1280, 800)
        few = np.asarray(picture.convert("RGB").resize((64, 40))).reshape(-1, 3)
        assert len(np.unique(few, axis=0)) > 20, "the picture is blank"


def test_each_picture_can_be_taken_anew_is_small_and_is_shown_by_a_document() -> None:
    pictures = list(take.FOLDER.glob("*.webp"))
    assert pictures and {path.stem for path in pictures} <= {*take.PICTURES, take.MOVING}
    assert all(path.stat().st_size < LARGEST for path in pictures)
    shown = "".join((ROOT / path).read_text(encoding="utf-8") for path in ("README.md", "docs/tutorial.md"))
    assert [path.name for path in pictures if f"pictures/{path.name}" not in shown] == []
