/** The page: its parts put together round one store. */

import { mountAssumptions } from "./assumptions.js";
import { boardKeys, mountBoard } from "./board/mount_board.js";
import { mountCoach } from "./coach.js";
import { mountDialogs } from "./dialogs/mount_dialogs.js";
import { mountDock } from "./dock/dock.js";
import { mountStatus } from "./dock/status.js";
import { byId } from "./dom.js";
import { titleOf } from "./gallery/tile.js";
import { mountGarments } from "./garments.js";
import { mountHistory } from "./history.js";
import { keyHandler } from "./keys.js";
import { language } from "./language/language.js";
import { fillIn, say } from "./language/say.js";
import { notice } from "./notices.js";
import { mountOffline } from "./offline.js";
import { mountPhone } from "./phone.js";
import { mountRobots } from "./robots.js";
import { mountSplitter } from "./splitter.js";
import { mountView3D, mountView3DEnd, mountView3DPlay } from "./view3d.js";
import { Rehearsal } from "./rehearsal/rehearsal.js";
import { Proposing } from "./proposals/proposing.js";
import { Suggestions } from "./suggestions/suggestions.js";
import { tellEffort } from "./settings/effort.js";
import { StepPictures } from "./step_pictures.js";
import { Store } from "./store.js";
import { Theme } from "./theme.js";
import { isViewOnly, viewOnly } from "./view_only.js";

fillIn(document);
const store = new Store(location.pathname.split("/").at(-1) ?? "");
const theme = new Theme();
const tellTheme = () => store.command({ do: "theme", dark: theme.isDark });
const togglePlay = () => store.command({ do: store.playback?.playing ? "pause" : "play" });

const rehearsal = new Rehearsal(store);
mountStatus(store, rehearsal, byId("status"));
mountAssumptions(store, byId("assumptions"));
const pictures = new StepPictures(store);
mountDock(store, pictures, rehearsal);
mountGarments(store);
mountRobots(store);
mountSplitter();
mountPhone(store);
const dialogs = mountDialogs(store, rehearsal);
const board = mountBoard(store, { togglePlay, startNew: dialogs.startNew, startImport: dialogs.startImport });
const suggestions = new Suggestions(store, byId("board"));
board.cover(suggestions);
board.play(pictures);
if (!isViewOnly) board.proposing = new Proposing(store, board);
mountCoach(board);
const verbs = {
  undo: () => board.takeBack() || store.undo(),
  redo: () => board.tool.isBusy || store.redo(),
  play: togglePlay,
  save: dialogs.save,
  settings: dialogs.settings,
  help: dialogs.help,
  gallery: dialogs.gallery,
};
mountHistory(store, verbs);
mountOffline(store);
mountView3DPlay(store, togglePlay);
mountView3DEnd(store);
const looking = { play: togglePlay, help: dialogs.help };
mountView3D(store, keyHandler(isViewOnly ? looking : verbs), board); // letters move the camera there

const keys = isViewOnly ? looking : { ...verbs, ...boardKeys(board), h: () => suggestions.takeFocus() };
document.addEventListener("keydown", keyHandler(keys));
theme.addEventListener("change", () => isViewOnly || tellTheme());
store.addEventListener("connection", () => {
  if (!store.isLive || isViewOnly) return;
  tellTheme();
  store.command({ do: "language", language });
  tellEffort(store);
});
store.addEventListener("refused", (event) => notice(/** @type {CustomEvent} */ (event).detail));
store.addEventListener("opened", (event) => {
  board.framing.fitNext();
  const replaced = /** @type {CustomEvent} */ (event).detail;
  if (replaced?.outline.length) notice(say("garments.replaced", { title: titleOf(replaced) }));
});
store.addEventListener("document", () => {
  document.title = `${titleOf(store.state?.drawing ?? { title: "", name: "" })} - Pleat`;
});
if (isViewOnly) viewOnly();
