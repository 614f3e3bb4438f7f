/** The list of keyboard shortcuts, made from the commands. */
import type { CommandGroup } from "../commands";
import { h, sheet } from "./dom";

const SIGNS: Record<string, string> = { ArrowRight: "→", ArrowLeft: "←", ArrowUp: "↑", ArrowDown: "↓", Escape: "Esc", "-": "−" };

/** `Shift+ArrowLeft` as one element for each key. */
export function keyCaps(keys: string): HTMLElement[] {
  const parts = keys === "+" ? ["+"] : keys.split("+");
  return parts.map((key) => h("kbd", {}, SIGNS[key] ?? key));
}

export function helpSheet(groups: CommandGroup[]): HTMLDialogElement {
  const sections = groups.map(([title, commands]) => {
    const rows = commands.filter(({ keys }) => keys.length > 0);
    return h("section", {}, h("h3", {}, title), h("dl", {}, ...rows.flatMap(({ keys, name }) => [h("dt", {}, ...keys.flatMap(keyCaps)), h("dd", {}, name)])));
  });
  const dialog = sheet("Keyboard shortcuts", "help", h("div", { class: "groups" }, ...sections));
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return dialog;
}
