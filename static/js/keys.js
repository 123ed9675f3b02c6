/** Keys that mean the same everywhere on the page, also while the 3D view has the focus. */

const TEXT_TYPES = new Set(["text", "search", "number", "file", "url", "email"]);

/** Whether keys belong to the text that is being written there. @param {EventTarget|null} target */
export function isTyping(target) {
  const part = /** @type {HTMLInputElement} */ (target);
  return part?.tagName === "TEXTAREA" || (part?.tagName === "INPUT" && TEXT_TYPES.has(part.type));
}

/**
 * @param {Record<string, () => void>} verbs what the keys do: undo, redo, save, settings, help, gallery, play, and tools by their letters
 * @returns {(event: KeyboardEvent) => void}
 */
export function keyHandler(verbs) {
  return (event) => {
    if (event.defaultPrevented || document.querySelector("dialog[open]")) return;
    const verb = verbs[named(event)];
    if (!verb) return;
    event.preventDefault();
    verb();
  };
}

/** The name of the verb that keys ask for; empty for none. @param {KeyboardEvent} event */
function named(event) {
  const target = /** @type {HTMLElement} */ (event.target);
  const key = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey) {
    if (event.altKey) return "";
    if (key === "s") return "save";
    if (key === ",") return "settings";
    if (isTyping(target)) return "";
    if (key === "z") return event.shiftKey ? "redo" : "undo";
    return key === "y" ? "redo" : "";
  }
  if (isTyping(target) || event.altKey) return "";
  if (key === " ") return ["BUTTON", "SELECT", "A"].includes(target.tagName) ? "" : "play";
  if (key === "?") return "help";
  if (key === "/") return "gallery";
  return target.tagName === "SELECT" ? "" : key;
}

/** Whether a key pressed there may be the board's. @param {KeyboardEvent} event */
export function isBoards(event) {
  const target = /** @type {HTMLElement} */ (event.target);
  return (
    !["INPUT", "TEXTAREA", "SELECT", "BUTTON", "A"].includes(target.tagName) && !document.querySelector("dialog[open]")
  );
}
