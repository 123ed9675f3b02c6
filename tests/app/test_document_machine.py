"""Random operations on a document over REST: no state is lost and none is stale.

A model of the document, independent of the server, runs beside it. Two pages listen all the time.
"""

import asyncio
import shutil
import tempfile
from pathlib import Path
from typing import Any

import httpx
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from app.api.create_app import create_app
from app.settings import Settings
from tests.app.conftest import OWN_URL
from tests.app.document_model import DocumentModel
from tests.app.samples import towel
from tests.app.websocket import Listener
from tests.patience import PATIENCE_S, wait_until

corners = st.integers(0, 3)
centimetres = st.integers(-2, 2)
keys = st.sampled_from(["one", "two"])


class DocumentMachine(RuleBasedStateMachine):
    """Operations on one document, and the invariants that must hold."""

    def __init__(self) -> None:
        super().__init__()
        self.loop = asyncio.new_event_loop()
        self.data = Path(tempfile.mkdtemp(prefix="pleat-"))
        self.model = DocumentModel()
        self.steps = 0

    @initialize()
    def begin(self) -> None:
        self.serve()
        answer = self.ask("POST", "", {"garment": towel()})
        assert answer.status_code == 201
        self.state = answer.json()
        self.listen()

    # rules: operations of pages

    @rule(corner=corners, x=centimetres, y=centimetres, key=keys)
    def drag(self, corner: int, x: int, y: int, key: str) -> None:
        drawing = self.pulled(corner, x, y)
        self.edit("preview", f"Drag {self.steps}", drawing, key)

    @rule(corner=corners, x=centimetres, y=centimetres, key=keys)
    def drop(self, corner: int, x: int, y: int, key: str) -> None:
        self.edit("commit", f"Drop {self.steps}", self.pulled(corner, x, y), key)

    @rule(across=st.floats(0.05, 0.35))
    def draw_fold(self, across: float) -> None:
        """Draw a fold from the middle of the cloth as it lies, in any direction; it may be illegal."""
        fold = {"name": "", "kind": "blue", "start": {"point": [across, 0.15]}, "end": {"point": [across, 0.3]}}
        folds = [*self.state["drawing"]["folds"][:1], fold]
        self.edit("commit", f"Fold {self.steps}", {**self.state["drawing"], "folds": folds}, "fold")

    @rule()
    def rub_out_folds(self) -> None:
        self.edit("commit", f"Rub out {self.steps}", {**self.state["drawing"], "folds": []}, "rub")

    @rule()
    def spoil(self) -> None:
        """Exchange two corners, so that the outline crosses itself or no longer does."""
        first, second, *rest = self.state["drawing"]["outline"]
        self.edit("commit", f"Spoil {self.steps}", {**self.state["drawing"], "outline": [second, first, *rest]}, "x")

    @rule()
    def cancel(self) -> None:
        body = {"base_version": self.state["version"], "phase": "cancel"}
        self.changed(self.ask("PUT", "/drawing", body), self.model.drop_gesture(self.state["drawing"]))

    @rule(in_the_middle=st.booleans())
    def undo(self, in_the_middle: bool = False) -> None:
        self.drag_on(in_the_middle)
        self.changed(self.ask("POST", "/undo"), self.model.undo(self.state["drawing"]))

    @rule(in_the_middle=st.booleans())
    def redo(self, in_the_middle: bool = False) -> None:
        self.drag_on(in_the_middle)
        body = {"base_version": self.state["version"]}
        self.changed(self.ask("POST", "/redo", body), self.model.redo(self.state["drawing"]))

    @precondition(lambda self: self.model.gesture is None)
    @rule()
    def undo_and_redo(self) -> None:
        before = self.state
        can_undo = self.model.past != []
        self.undo()
        if can_undo:
            self.redo()
        assert self.state["drawing"] == before["drawing"]
        assert self.state["history"] == before["history"]

    @precondition(lambda self: self.state["version"] > 1)
    @rule(corner=corners)
    def come_too_late(self, corner: int) -> None:
        body = {"base_version": self.state["version"] - 1, "drawing": self.pulled(corner, 1, 1)}
        answer = self.ask("PUT", "/drawing", body)
        assert answer.status_code == 409
        assert answer.json()["state"] == self.state

    @rule(in_the_middle=st.booleans())
    def kill_and_restart(self, in_the_middle: bool) -> None:
        """Kill the server and start another one on the same data."""
        self.drag_on(in_the_middle)
        killed = self.app
        self.serve()
        self.model.close_gesture(self.state["drawing"])
        state = self.ask("GET", "").json()
        assert state["version"] == self.state["version"]
        self.state = {**state, "gesture": None}
        self.run(self.hang_up())
        self.listen()
        killed.state.workspace.close()

    @rule()
    def rest(self) -> None:
        """Wait until nothing is going on; both pages show the same state, and the drawing's own plan."""
        self.run(self.until_idle())
        one, other = self.pages
        assert one.last["document"] == other.last["document"] == self.state
        assert one.last["plan"] == other.last["plan"]
        assert one.last["playback"] == other.last["playback"]
        plan = one.last["plan"]
        assert plan["version"] == self.state["version"]
        self.look_back(one)
        if self.state["problems"]:
            assert (plan["status"], plan["plan"]) == ("illegal", None)
            return
        assert (plan["plan"]["version"], plan["plan"]["is_stale"]) == (plan["version"], False)
        assert self.ask_at("GET", f"/api/plans/{plan['plan']['id']}").json()["status"] == plan["status"]

    @invariant()
    def nothing_is_lost(self) -> None:
        assert self.state["history"] == self.model.history
        assert self.state["gesture"] == (self.model.gesture[1] if self.model.gesture else None)
        assert self.ask("GET", "").json() == self.state

    # invariants

    def look_back(self, page: Listener) -> None:
        """Check that every plan that was shown as its version's was the plan of that version."""
        garments = {one["version"]: one["garment"] for one in page.heard if one["kind"] == "document"}
        layers: dict[int, object] = {}
        for shown in (one for one in page.heard if one["kind"] == "plan" and one["plan"]):
            version = shown["plan"]["version"]
            if version not in garments:
                continue  # the page was told of a later version before it could be told of this one
            if version not in layers:
                layers[version] = self.ask_at("POST", "/api/dag", {"garment": garments[version]}).json()["layers"]
            assert shown["plan"]["final_layers"] == layers[version]
            assert shown["plan"]["is_stale"] == (version != shown["version"])
        page.heard = [one for one in page.heard if one["kind"] == "document"]

    def drag_on(self, in_the_middle: bool) -> None:
        """Leave a gesture in progress, possibly, while another operation happens."""
        if in_the_middle:
            self.steps += 1
            self.edit("preview", f"Drag {self.steps}", self.pulled(self.steps % 4, 2, self.steps % 3), "middle")

    def edit(self, phase: str, label: str, drawing: dict[str, Any], key: str) -> None:
        self.steps += 1
        body = {"base_version": self.state["version"], "label": label, "phase": phase, "drawing": drawing}
        answer = self.ask("PUT", "/drawing", {**body, "gesture": key})
        assert answer.status_code == 200, answer.text
        after = answer.json()["drawing"]
        self.model.edit(phase, label, key, self.state["drawing"], after)
        self.changed(answer, after)

    def changed(self, answer: httpx.Response, drawing: object) -> None:
        """Take the new state; its version has grown if and only if something in it has changed."""
        assert answer.status_code == 200, answer.text
        state = answer.json()
        assert state["drawing"] == drawing
        is_same = {**state, "version": 0} == {**self.state, "version": 0}
        assert state["version"] >= self.state["version"] + (not is_same)
        self.state = state

    def pulled(self, corner: int, x: int, y: int) -> dict[str, Any]:
        """Return the drawing with a corner moved from the towel's by some centimetres."""
        outline = list(self.state["drawing"]["outline"])
        home = towel()["outline"][corner]
        outline[corner] = {**outline[corner], "point": [home[0] + 0.01 * x, home[1] + 0.01 * y]}
        return {**self.state["drawing"], "outline": outline}

    # the server

    def serve(self) -> None:
        self.app: Any = create_app(Settings(data=self.data))
        transport = httpx.ASGITransport(app=self.app)
        self.client = httpx.AsyncClient(transport=transport, base_url=OWN_URL, timeout=PATIENCE_S)

    def listen(self) -> None:
        async def connected() -> list[Listener]:
            pages = [Listener(self.app, f"/api/documents/{self.state['id']}/live") for _ in range(2)]
            pages[0].keep_all = True
            return pages

        self.pages = self.run(connected())

    def ask(self, method: str, path: str, body: object = None) -> httpx.Response:
        document = f"/{self.state['id']}" if hasattr(self, "state") else ""
        return self.ask_at(method, f"/api/documents{document}{path}", body)

    def ask_at(self, method: str, path: str, body: object = None) -> httpx.Response:
        answer: httpx.Response = self.run(self.client.request(method, path, json=body))
        return answer

    async def until_idle(self) -> None:
        await asyncio.to_thread(wait_until, self.are_idle)

    def are_idle(self) -> bool:
        one, other = self.pages
        return self.is_idle(one) and self.is_idle(other) and one.last == other.last

    def is_idle(self, page: Listener) -> bool:
        versions = [page.last.get(kind, {}).get("version") for kind in ("document", "plan")]
        if versions != [self.state["version"]] * 2:
            return False
        plan, playback = page.last["plan"], page.last.get("playback", {})
        has_checks = plan["checks"] is not None and plan["checks"]["version"] == plan["version"]
        has_film = playback.get("version") == (plan["version"] if plan["status"] == "solved" else None)
        is_settled = plan["status"] != "planning" and (plan["plan"] is None or plan["plan"]["is_final"])
        return is_settled and has_checks and has_film

    def run(self, work: Any) -> Any:
        return self.loop.run_until_complete(work)

    async def hang_up(self) -> None:
        for page in self.pages:
            await page.hang_up()

    def teardown(self) -> None:
        if hasattr(self, "pages"):
            self.run(self.hang_up())
        if getattr(self, "app", None) is not None:
            self.app.state.workspace.close()
        self.loop.run_until_complete(self.loop.shutdown_default_executor())
        self.loop.close()
        shutil.rmtree(self.data)


DocumentMachine.TestCase.settings = settings(
    max_examples=max(8, settings.default.max_examples // 10) if settings.default else 8, stateful_step_count=15
)
TestDocument = DocumentMachine.TestCase
