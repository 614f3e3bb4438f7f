/** Runs commands by their keys. */
import type { CommandGroup } from "./commands";

function isTextField(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement) return !["checkbox", "radio", "range", "color", "button"].includes(target.type);
  return target instanceof HTMLTextAreaElement;
}

/** Whether Space plays or pauses: everywhere except in fields for text and in dialogs. Enter presses buttons. */
const takesSpace = (event: KeyboardEvent): boolean =>
  event.key === " " && !event.ctrlKey && !event.metaKey && !event.altKey && !isTextField(event.target) && !(event.target as Element).closest?.("dialog");

/** Elements that handle these keys themselves. */
function takesKeys(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog") || isTextField(target)) return true;
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement) {
    if (target.type === "checkbox" || target.type === "radio") return key.startsWith("Arrow");
    return target.type !== "range" || key.startsWith("Arrow") || ["Home", "End", "PageUp", "PageDown"].includes(key);
  }
  if (target instanceof HTMLButtonElement || target.tagName === "SUMMARY") return key === "Enter";
  return (target.getAttribute("role") ?? "").endsWith("grid") && (key.startsWith("Arrow") || key === "Home" || key === "End");
}

/** The keys of an event as commands name them: `Shift+F`. Shift belongs to the name of letters and arrows only: elsewhere it makes another character. */
function chordOf({ key, shiftKey, altKey, ctrlKey, metaKey }: KeyboardEvent): string {
  const isLetter = /^[a-z]$/i.test(key);
  const withShift = shiftKey && (isLetter || key.startsWith("Arrow"));
  return `${ctrlKey || metaKey ? "Ctrl+" : ""}${altKey ? "Alt+" : ""}${withShift ? "Shift+" : ""}${isLetter ? key.toUpperCase() : key}`;
}

export function listenToKeys(groups: CommandGroup[]): void {
  const commands = groups.flatMap(([, list]) => list).filter(({ run }) => run);
  const byKeys = new Map(commands.flatMap((command) => command.keys.map((keys) => [keys, command.run!])));
  document.addEventListener("keydown", (event) => {
    if (takesSpace(event)) {
      event.preventDefault();
      if (!event.repeat) byKeys.get("Space")!();
      return;
    }
    const chord = chordOf(event);
    const isOfPage = chord.startsWith("Ctrl+") ? !document.querySelector("dialog[open]") : !takesKeys(event.target, event.key);
    if (event.defaultPrevented || !isOfPage) return;
    if (event.key === "Enter" && event.target instanceof HTMLInputElement && event.target.type === "checkbox") {
      event.target.click();  // as Space does elsewhere
      event.preventDefault();
    } else if (byKeys.has(chord) && byKeys.get(chord)!() !== false) event.preventDefault();
  });
  // Firefox presses a button when the key goes up.
  document.addEventListener("keyup", (event) => {
    if (takesSpace(event)) event.preventDefault();
  });
}
