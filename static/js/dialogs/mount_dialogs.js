/** The buttons `New`, `Import`, `Export`, jobs and help. */

import { byId, element } from "../dom.js";
import { showGallery } from "../gallery/gallery.js";
import { icon } from "../icons.js";
import { say } from "../language/say.js";
import { showExport } from "./export.js";
import { showHelp } from "./help.js";
import { showSettings } from "../settings/settings.js";
import { acceptDrops, showImport } from "./import.js";
import { offerJobs, showJobs } from "./jobs.js";
import { showNew } from "./new.js";
import { showRename } from "./rename.js";
import { showShare } from "./share.js";
import { showWhoFolds } from "./who_folds.js";

/** @param {import("../store.js").Store} store @param {import("../rehearsal/rehearsal.js").Rehearsal} rehearsal */
export function mountDialogs(store, rehearsal) {
  const verbs = {
    startNew: () => showNew(),
    gallery: () => showGallery(store),
    startImport: () => showImport(store),
    help: () => showHelp(),
    save: () => save(store),
    settings: () => showSettings(store),
  };
  /**
   * @param {string} id of the button
   * @param {Parameters<typeof icon>[0]} name of its icon
   * @param {string} word
   * @param {() => void} verb
   */
  const put = (id, name, word, verb) => {
    byId(id).append(icon(name), ...(word ? [element("span", "word", word)] : []));
    byId(id).addEventListener("click", verb);
  };
  put("gallery", "gallery", "", verbs.gallery);
  put("new", "new", say("bar.new"), verbs.startNew);
  put("import", "import", say("bar.import"), verbs.startImport);
  put("export", "export", say("bar.export"), () => showExport(store));
  put("jobs", "jobs", "", () => showJobs(rehearsal));
  offerJobs(byId("jobs"));
  addEventListener("focus", () => offerJobs(byId("jobs")));
  put("settings", "settings", "", verbs.settings);
  put("help", "help", "", verbs.help);
  put("share", "share", "", () => showShare(store));
  put("rename", "rename", "", () => showRename(store));
  byId("compare").addEventListener("click", () => showWhoFolds(store));
  const able = () => ["rename", "compare"].forEach((id) => byId(id).toggleAttribute("disabled", false));
  store.addEventListener("document", able, { once: true });
  acceptDrops(store);
  return verbs;
}

/** The garment as a file, as it is drawn. @param {import("../store.js").Store} store */
function save(store) {
  if (!store.state) return;
  const { garment } = store.state;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([`${JSON.stringify(garment, null, 2)}\n`], { type: "application/json" }));
  link.download = `${garment.name}.json`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
