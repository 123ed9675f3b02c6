"""The page in other languages: chosen in the settings, kept, and spoken everywhere."""

import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, Route, expect

from tests.app.conftest import REST, Served
from tests.browser.conftest import Garment, Sheet, windows
from tests.messages import FOLDS, MESSAGES

NewSheet = Callable[[Garment], Sheet]

READ = """() => {
  const shown = (part) => part.checkVisibility({ visibilityProperty: true });
  const texts = [];
  for (const part of document.querySelectorAll("body *")) {
    if (!shown(part) || part.closest("script, style, iframe")) continue;
    for (const name of ["aria-label", "title", "placeholder", "aria-description"])
      if (part.getAttribute(name)) texts.push(part.getAttribute(name));
    for (const node of part.childNodes) if (node.nodeType === Node.TEXT_NODE && node.data.trim()) texts.push(node.data);
  }
  return texts;
}"""
"""Everything that is read or heard of the page as it is."""

KEPT = re.compile(r"Pleat|PR2|English|Deutsch|Espa\u00f1ol|cm|mm|1\u00d7|[\d.,/\s\u00d7]+ ?(s|cm)?")
"""Names and numbers that are the same in every language."""


def choose(page: Page, language: str, settings: str) -> None:
    """Choose a language in the settings, which open by a key; the page comes again."""
    page.locator("body").press("Control+,")
    with page.expect_navigation():
        page.get_by_role("dialog", name=settings).get_by_role("combobox").first.select_option(language)


def test_a_language_is_chosen_in_the_settings_and_kept_for_the_next_visit(page: Page, new_sheet: NewSheet) -> None:
    page.goto(new_sheet("t-shirt").page_url)
    html, undo = page.locator("html"), page.locator("#undo")
    expect(html).to_have_attribute("lang", "en")
    expect(page.get_by_role("button", name="left sleeve", exact=True)).to_be_visible()
    choose(page, "de", "Settings")
    expect(html).to_have_attribute("lang", "de")
    expect(page.get_by_role("button", name="linker \u00c4rmel", exact=True)).to_be_visible()
    expect(undo).to_have_attribute("aria-label", "R\u00fcckg\u00e4ngig")
    expect(page.get_by_role("toolbar", name="Werkzeuge").get_by_role("button").first).to_have_accessible_name(
        "Ausw\u00e4hlen"
    )
    expect(page.locator(".clock")).to_contain_text(",")
    choose(page, "es", "Einstellungen")
    expect(html).to_have_attribute("lang", "es")
    expect(page.get_by_role("button", name="manga izquierda", exact=True)).to_be_visible()
    page.goto(page.url)
    expect(html).to_have_attribute("lang", "es")
    choose(page, "en", "Ajustes")
    expect(undo).to_have_attribute("aria-label", "Undo")
    expect(page.get_by_role("button", name="left sleeve", exact=True)).to_be_visible()


@pytest.mark.parametrize("language", ["de", "es"])
def test_every_message_of_the_server_has_words_in_each_language(
    chromium: Browser, designer: Served, language: str
) -> None:
    with windows(chromium) as context:
        page = context.new_page()
        page.goto(f"{designer.url}/static/icon.svg")
        page.evaluate("(code) => localStorage.setItem('pleat-language', code)", language)
        page.reload()
        words: list[str] = page.evaluate(
            """async ([messages, folds]) => {
              const { inWords } = await import("/static/js/messages/in_words.js");
              return messages.map((says) => inWords({ says, message: "RUBBISH" }, folds));
            }""",
            [MESSAGES, FOLDS],
        )
    for told in (re.sub(re.escape(FOLDS[1]["name"]), "", one) for one in words):
        assert not re.search(r"RUBBISH|undefined|NaN|null|object|\{|\b(the|of the|must|from|which)\b|\d\.\d", told), (
            told
        )


def bracketed(value: Any) -> Any:
    """Return a catalogue's texts in brackets, so that words from elsewhere are told from them."""
    if isinstance(value, dict):
        return {key: bracketed(text) for key, text in value.items()}
    return f"[{value}]"


def test_all_that_is_read_or_heard_comes_from_the_catalogues(page: Page, designer: Served, new_sheet: NewSheet) -> None:
    def catalogue(route: Route) -> None:
        route.fulfill(json=bracketed(route.fetch().json()))

    page.route("**/words/de.json", catalogue)
    page.add_init_script("try { localStorage.setItem('pleat-language', 'de') } catch {}")  # not in viser's frame
    sheet = new_sheet("t-shirt")
    titles = {entry["title"] for entry in REST.get(f"{designer.url}/api/documents").json()}
    page.goto(sheet.page_url)
    expect(page.locator(".fold-name")).to_have_count(5)
    seen: list[str] = page.evaluate(READ)
    for button in ("#settings", "#help", "#new", "#export", "#import", "#gallery"):
        page.locator(button).click()
        page.wait_for_timeout(300)
        seen += page.evaluate(READ)
        page.keyboard.press("Escape")
    assert {text for text in seen if "[" not in text and "]" not in text and not spared(text)} - titles == set()


def spared(text: str) -> bool:
    """Return whether a text is a name, a number or a key."""
    return bool(KEPT.fullmatch(text.strip())) or not re.search(r"[^\W\d_]{2}", text)
