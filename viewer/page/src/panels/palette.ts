/** The command palette: finds commands, objects, tabs and settings by a few letters. */
import type { Command } from "../commands";
import { fuzzyScore } from "../fuzzy";
import type { Model } from "../model";
import { h } from "./dom";
import { keyCaps } from "./help";

/** What the palette offers: a command in its group, or a place to go to. */
export interface Offer {
  name: string;
  group: string;
  keys?: string[] | undefined;
  /** The object to which the command is applied. */
  subject?: string;
  run(): void;
}

const MOST_OFFERS = 60;
/** So many objects are offered, each with what can be done with it. */
const MOST_OBJECTS = 8;

export class Palette {
  readonly element: HTMLDialogElement;
  private readonly field: HTMLInputElement;
  private readonly list = h("ul", { role: "listbox", id: "palette-list", "aria-label": "Commands" });
  private readonly nothing = h("p", { class: "hint", role: "status" });
  private offers: Offer[] = [];
  private chosen = 0;

  /** `fixed` gives all that is not an object. `act` does something with an object. */
  constructor(private readonly model: Model, private readonly fixed: () => Offer[], private readonly ofObject: (object: number) => Offer[]) {
    this.field = h("input", {
      type: "text", role: "combobox", "aria-expanded": "true", "aria-controls": "palette-list", "aria-autocomplete": "list", "aria-label": "Command, object, layer or setting",
      placeholder: "Command, object, layer or setting", autocomplete: "off", spellcheck: "false", oninput: () => this.update(),
    });
    this.element = h("dialog", { class: "palette", "aria-label": "Command palette" }, this.field, this.list, this.nothing);
    this.element.addEventListener("keydown", (event) => this.key(event));
    this.element.addEventListener("click", (event) => event.target === this.element && this.element.close());
  }

  open(): void {
    this.field.value = "";
    this.element.showModal();
    this.field.focus();
    this.update();
  }

  private update(): void {
    const wanted = this.field.value;
    const found = this.fixed().map((offer) => ({ offer, score: fuzzyScore(wanted, offer.name) || fuzzyScore(wanted, `${offer.group} ${offer.name}`) / 2 }));
    const objects = wanted.trim() === "" ? [] : this.objectsLike(wanted).flatMap((object) => this.ofObject(object)).map((offer) => ({ offer, score: this.scoreOf(wanted, offer) }));
    this.offers = [...found, ...objects].filter(({ score }) => score > 0).sort((p, q) => q.score - p.score).slice(0, MOST_OFFERS).map(({ offer }) => offer);
    this.list.replaceChildren(...this.offers.map((offer, i) => this.row(offer, i)));
    this.nothing.textContent = this.offers.length === 0 ? `Nothing is like “${wanted.trim()}”.` : "";
    this.choose(0);
  }

  /** Also with a verb before the name: `hide ball 3`. */
  private objectsLike(wanted: string): number[] {
    const name = wanted.trim().replace(/^(select|show|only|hide|isolate|pin)\s+/i, "");
    const scored = this.model.objects.map((object) => ({ object: object.index, score: fuzzyScore(name, object.name) }));
    return scored.filter(({ score }) => score > 0).sort((p, q) => q.score - p.score).slice(0, MOST_OBJECTS).map(({ object }) => object);
  }

  /** What can be done with an object has one score, so that it stays in its order, unless a verb is typed. */
  private scoreOf(wanted: string, { name, subject }: Offer): number {
    return fuzzyScore(wanted, subject!) || fuzzyScore(wanted, name);
  }

  private row({ name, group, keys }: Offer, i: number): HTMLElement {
    const caps = keys?.[0] ? keyCaps(keys[0]) : [];
    return h(
      "li", { role: "option", id: `palette-${i}`, "aria-selected": "false", onclick: () => this.run(i), onpointermove: () => this.choose(i, false) },
      h("span", { class: "text" }, name), h("span", { class: "group-name" }, group), ...caps,
    );
  }

  private choose(i: number, reveals = true): void {
    const rows = [...this.list.children];
    rows[this.chosen]?.setAttribute("aria-selected", "false");
    this.chosen = i;
    const row = rows[i];
    row?.setAttribute("aria-selected", "true");
    if (reveals) row?.scrollIntoView({ block: "nearest" });
    if (row) this.field.setAttribute("aria-activedescendant", row.id);
    else this.field.removeAttribute("aria-activedescendant");
  }

  private key(event: KeyboardEvent): void {
    const count = this.offers.length;
    const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1 };
    if (event.key in steps && count > 0) this.choose((this.chosen + steps[event.key]! + count) % count);
    else if (event.key === "Enter") this.run(this.chosen);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private run(i: number): void {
    const offer = this.offers[i];
    if (!offer) return;
    this.element.close();  // gives the focus back first, so that the command may move it
    offer.run();
  }
}

export const offersOf = (groups: [string, Command[]][]): Offer[] =>
  groups.flatMap(([group, commands]) => commands.flatMap(({ name, keys, run }) => (run ? [{ name, group, keys, run: () => void run() }] : [])));
