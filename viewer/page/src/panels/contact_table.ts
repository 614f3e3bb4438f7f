/** A table of all contacts of the frame. */
import { contactCount, findContact, involves, keyAt, kindAt, sidesOf } from "../contacts";
import type { Model } from "../model";
import { h, readable } from "./dom";
import { makeRow, RowWindow, type Row } from "./row_window";

const ROW_HEIGHT = 24;

export class ContactTable {
  readonly element: HTMLElement;
  private readonly summary = h("p", { class: "hint", "aria-live": "off" });
  private readonly window: RowWindow<Row>;
  private readonly only = h("input", { type: "checkbox" });
  /** Indices of the listed contacts; null for all. */
  private listed: number[] | null = null;

  constructor(private readonly model: Model, private readonly fly: () => void) {
    this.window = new RowWindow(
      { class: "table-view", role: "grid", "aria-label": "Contacts", tabindex: 0, onkeydown: (event: KeyboardEvent) => this.key(event) },
      h("div", { class: "rows" }), ROW_HEIGHT, () => makeRow(5, (index) => this.choose(index), (row, cells, index) => this.showRow(row, cells, index)),
    );
    this.only.addEventListener("change", () => this.update());
    const names = ["object a", "", "object b", "", "kind"].map((name) => h("span", {}, name));
    this.element = h(
      "div", { class: "contacts" },
      h("div", { class: "table-top" }, this.summary, h("label", { title: "Only contacts of the selected object" }, this.only, "Selected object")),
      h("div", { class: "row head", "aria-hidden": "true" }, ...names),
      this.window.element,
    );
    model.on("frame", () => this.update());
    model.on("scene", () => this.update());
    model.on("selection", () => (this.only.checked ? this.update() : this.window.draw()));
  }

  private get count(): number {
    const { frame } = this.model;
    return this.listed ? this.listed.length : frame ? contactCount(frame) : 0;
  }

  private update(): void {
    const { frame, selection } = this.model;
    this.listed = null;
    if (frame && this.only.checked && selection) {
      this.listed = [];
      for (let place = 0; place < contactCount(frame); ++place) if (involves(frame, place, selection.object)) this.listed.push(place);
    }
    const near = frame && frame.proximityPairs.length > 0 ? `${readable(frame.proximityPairs.length / 2)} proximity pairs · ` : "";
    const text = frame ? `${readable(this.count)} contacts · ${near}${readable(frame.objectPairs.length / 2)} object pairs` : "";
    if (this.summary.textContent !== text) this.summary.textContent = text;
    this.window.element.setAttribute("aria-rowcount", String(this.count));
    this.window.setCount(this.count);
  }

  private showRow(row: HTMLElement, cells: HTMLElement[], index: number): void {
    const frame = this.model.frame!;
    const place = this.listed ? this.listed[index]! : index;
    const key = keyAt(frame, place);
    const { kinds } = this.model.scene!;
    const sides = sidesOf(key, kinds).flatMap(({ object, elements }) => [this.model.objects[object]!.name, elements.join("–")]);
    [...sides, kindAt(frame, place, kinds)].forEach((text, i) => {
      if (cells[i]!.textContent !== text) cells[i]!.textContent = text;
    });
    row.setAttribute("aria-rowindex", String(index + 1));
    const { contact } = this.model;
    const selected = contact !== null && contact.length === key.length && contact.every((id, i) => id === key[i]);
    row.setAttribute("aria-selected", String(selected));
  }

  private choose(index: number): void {
    if (index >= this.count) return;  // it has disappeared meanwhile
    const place = this.listed ? this.listed[index]! : index;
    this.model.selectContact(keyAt(this.model.frame!, place));
    this.window.reveal(index);
    this.fly();
  }

  private key(event: KeyboardEvent): void {
    const next = this.window.rowAfter(event.key, this.chosenRow());
    if (next === null) return;
    event.preventDefault();
    event.stopPropagation();
    this.choose(next);
  }

  private chosenRow(): number {
    const { contact, frame } = this.model;
    if (!contact || !frame) return -1;
    const place = findContact(frame, contact);
    return this.listed ? this.listed.indexOf(place) : place;
  }
}
