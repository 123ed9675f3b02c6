"""The list in the bar: a choice opens a document; no drawing is left or replaced without a question."""

import json
from collections.abc import Callable

from playwright.sync_api import FilePayload, Locator, Page, expect
from sqlalchemy import delete, insert

from app.api.document_routes import PAGE_MAX
from app.drawing.drawing_json import drawing_to_dict
from app.store.database import Database
from app.store.document_keeper import FORMAT
from app.store.schema import DocumentRow, StepRow
from planner.robots.known_robots import robot_names
from tests.app.conftest import Served
from tests.app.samples import towel
from tests.app.store.drafts import TOWEL
from tests.browser.board.conftest import page as page
from tests.browser.conftest import Garment, Sheet

NewSheet = Callable[[Garment], Sheet]


def bar(page: Page) -> Locator:
    return page.get_by_role("combobox", name="Garment")


def document_of(page: Page) -> str:
    return page.url.rpartition("/")[2]


def test_choosing_a_garment_opens_it_and_leaves_what_was_open_in_the_list(page: Page, new_sheet: NewSheet) -> None:
    sheet = new_sheet(towel(title="My own towel"))
    page.goto(sheet.page_url)
    before, own = sheet.state, document_of(page)
    bar(page).select_option("garment:scarf")
    page.wait_for_url(lambda url: not url.endswith(own))
    expect(bar(page).locator("option:checked")).to_have_text("Scarf")
    expect(page.locator(".fold-row")).to_have_count(2)
    assert sheet.state["version"] == before["version"]
    assert sheet.drawing == before["drawing"]
    bar(page).select_option(label="My own towel")
    page.wait_for_url(f"**/{own}")
    expect(bar(page).locator("option:checked")).to_have_text("My own towel")


def test_each_garment_and_robot_has_its_picture_in_the_list(page: Page, new_sheet: NewSheet) -> None:
    sheet = new_sheet("vest")
    page.goto(sheet.page_url)
    expect(page.locator("#robot option .picture-robot")).to_have_count(len(robot_names()))
    bar(page).click()
    options = bar(page).locator("option")
    expect(options.locator(".picture")).to_have_count(options.count())
    made_of = bar(page).locator("option[value^='garment:']")
    expect(made_of.locator(".picture-cloth")).to_have_count(made_of.count())
    own, same = (
        bar(page).locator(f"option[value='{value}'] svg") for value in (bar(page).input_value(), "garment:vest")
    )
    expect(own.locator(".picture-cloth")).to_have_count(1)
    assert own.inner_html() == same.inner_html()
    page.keyboard.press("Escape")


def test_a_document_without_a_name_of_its_own_stays_in_the_list(page: Page, new_sheet: NewSheet) -> None:
    blank, other = new_sheet(None), new_sheet("scarf")
    page.goto(other.page_url)
    address = f"document:{blank.page_url.rpartition('/')[2]}"
    choice = bar(page).locator(f"option[value='{address}']")
    expect(choice).to_have_count(1)
    expect(choice).to_contain_text("Untitled")
    bar(page).select_option(address)
    page.wait_for_url(blank.page_url)


def test_a_document_made_elsewhere_is_listed_once_the_list_is_gone_to(page: Page, new_sheet: NewSheet) -> None:
    page.goto(new_sheet("scarf").page_url)
    expect(bar(page).locator("option:checked")).to_have_text("Scarf")
    elsewhere = new_sheet(towel(title="Made elsewhere"))
    bar(page).focus()
    expect(bar(page).locator(f"option[value$='{elsewhere.page_url.rpartition('/')[2]}']")).to_have_text(
        "Made elsewhere"
    )


def test_the_list_has_all_documents_however_many_pages_they_fill(
    page: Page, new_sheet: NewSheet, designer: Served
) -> None:
    page.goto(new_sheet("scarf").page_url)
    expect(bar(page).locator("option:checked")).to_have_text("Scarf")
    names = [f"many{number:04}" for number in range(PAGE_MAX + 20)]
    blank = {
        "format": FORMAT,
        "revision": 0,
        "version": 1,
        "changed_at": "",
        "title": "",
        "name": "",
        "first": 0,
        "now": 0,
    }
    drawing = json.dumps(drawing_to_dict(TOWEL.drawing))
    database = Database(designer.data / "pleat.db")
    with database.writing("many") as session:
        session.execute(insert(DocumentRow), [{"id": name, **blank} for name in names])
        step = {"number": 0, "label": "", "changed_at": "", "drawing": drawing}
        session.execute(insert(StepRow), [{"document_id": name, **step} for name in names])
    bar(page).focus()
    expect(bar(page).locator("option[value^='document:many']")).to_have_count(len(names))
    with database.writing("no more") as session:
        session.execute(delete(DocumentRow).where(DocumentRow.id.in_(names)))
    database.close()


def test_without_the_server_the_document_stays_and_it_is_said(page: Page, new_sheet: NewSheet) -> None:
    sheet = new_sheet("scarf")
    page.goto(sheet.page_url)
    expect(page.locator(".fold-row")).to_have_count(2)
    expect(bar(page).locator("option[value='garment:tie']")).to_be_attached()
    page.route("**/api/documents", lambda route: route.abort())
    bar(page).select_option("garment:tie")
    expect(page.get_by_role("log", name="Notices")).to_contain_text("nothing was opened")
    expect(bar(page).locator("option:checked")).to_have_text("Scarf")
    assert page.url == sheet.page_url
    page.unroute_all()


def test_an_import_says_what_it_replaces_before_and_after(page: Page, new_sheet: NewSheet) -> None:
    page.goto(new_sheet(towel(title="My own towel")).page_url)
    page.get_by_role("button", name="Import", exact=True).click()
    line = '<svg xmlns="http://www.w3.org/2000/svg" width="40cm" height="30cm" viewBox="0 0 40 30">'
    content = f'{line}<path d="M0 0H40V30H0Z" fill="none" stroke="black"/></svg>'
    file = FilePayload(name="cloth.svg", mimeType="image/svg+xml", buffer=content.encode())
    page.get_by_label("File", exact=True).set_input_files([file])
    dialog = page.get_by_role("dialog", name="Import")
    expect(dialog).to_contain_text("it replaces \u201cMy own towel\u201d; Undo brings that back")
    expect(dialog.get_by_role("button", name="As a new document")).to_be_focused()
    dialog.get_by_role("button", name="Open here").click()
    expect(page.get_by_role("log", name="Notices")).to_contain_text("\u201cMy own towel\u201d was replaced")
    page.get_by_role("button", name="Undo").click()
    expect(bar(page).locator("option:checked")).to_contain_text("My own towel")


def test_on_a_phone_a_title_of_25_letters_is_read_whole(phone: Page, new_sheet: NewSheet) -> None:
    phone.goto(new_sheet(towel(title="Grandmother's blue shirts")).page_url)
    title = bar(phone)
    expect(title).to_contain_text("Grandmother's")
    assert title.evaluate("(list) => list.scrollWidth <= list.clientWidth && list.scrollHeight <= list.clientHeight")
