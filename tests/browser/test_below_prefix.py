from collections.abc import Callable

import pytest
from playwright.sync_api import Browser, expect

from tests.app.conftest import Served
from tests.browser.conftest import IS_THERE, REST, Garment, Sheet, new_view_page
from tests.browser.prefix_proxy import PREFIX, below_prefix
from tests.browser.status_pill import expect_planned


@pytest.mark.long
@pytest.mark.slow
def test_page_3d_view_and_edits_work_below_a_proxys_prefix(
    browser: Browser, designer: Served, new_sheet: Callable[[Garment], Sheet]
) -> None:
    REST.get(new_sheet("t-shirt").page_url).raise_for_status()  # the address without a document leads to the last one
    with below_prefix(designer.port) as url:
        faults: list[str] = []
        page = new_view_page(browser)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("response", lambda answer: faults.append(answer.url) if answer.status >= 400 else None)
        page.goto(f"{url}/")
        expect_planned(page)
        assert page.url.startswith(f"{url}/d/")
        page.wait_for_function(IS_THERE, arg="/cloth/front")
        page.locator("#garment").select_option("garment:hand-towel")
        expect(page).to_have_title("Hand towel - Pleat")
        expect_planned(page)
        page.goto(f"{url}/docs")
        expect(page.get_by_role("heading", name="Pleat")).to_be_visible()
        expect(page.get_by_text("POST", exact=True).first).to_be_visible()
        page.close()
    assert PREFIX in url and faults == []
