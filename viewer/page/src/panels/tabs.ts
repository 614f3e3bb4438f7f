/** Pages of which one is visible, and the tabs that choose it. */
import { h } from "./dom";

export class Tabs {
  readonly element: HTMLElement;
  readonly names: string[];
  /** The open page. */
  open = "";
  private readonly buttons: HTMLButtonElement[];
  private readonly panels: HTMLElement[];

  constructor(pages: Record<string, HTMLElement>, label: string) {
    this.names = Object.keys(pages);
    this.buttons = this.names.map((name) =>
      h("button", { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `page-${name}`, onclick: () => this.show(name) }, name),
    );
    this.panels = this.names.map((name) => h("div", { role: "tabpanel", tabindex: 0, id: `page-${name}`, "aria-labelledby": `tab-${name}`, class: "page" }, pages[name]!));
    const bar = h("div", { class: "tabs", role: "tablist", "aria-label": label, onkeydown: (event: KeyboardEvent) => this.key(event) }, ...this.buttons);
    this.element = h("aside", { class: "panel right", "aria-label": label }, bar, ...this.panels);
  }

  show(wanted: string): void {
    this.open = wanted;
    this.names.forEach((name, i) => {
      this.panels[i]!.hidden = name !== wanted;
      this.buttons[i]!.setAttribute("aria-selected", String(name === wanted));
      this.buttons[i]!.tabIndex = name === wanted ? 0 : -1;
    });
  }

  private key(event: KeyboardEvent): void {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    event.preventDefault();
    event.stopPropagation();
    const next = this.buttons[(this.names.indexOf(this.open) + step + this.names.length) % this.names.length]!;
    next.click();
    next.focus();
  }
}
