/** All contacts of the frame, as many as there are: only the rows in sight have elements. */
import { contactCount, findContact, involves, keyAt, kindAt, sidesOf } from "../contacts";
import type { Model } from "../model";
import { h, readable } from "./dom";

const ROW = 24;
/** Browsers give up on elements that are higher than this. */
const HIGHEST = 8_000_000;

export class ContactTable {
  readonly element: HTMLElement;
  private readonly summary = h("p", { class: "hint", "aria-live": "off" });
  private readonly body = h("div", { class: "rows" });
  private readonly spacer = h("div", { class: "spacer" });
  private readonly viewport: HTMLElement;
  private readonly only = h("input", { type: "checkbox" });
  /** Places of the contacts that are listed; null for all of them. */
  private listed: number[] | null = null;
  private rows: HTMLElement[] = [];

  constructor(private readonly model: Model, private readonly fly: () => void) {
    this.viewport = h(
      "div",
      { class: "table-view", role: "grid", "aria-label": "Contacts", tabindex: 0, onscroll: () => this.draw(), onkeydown: (event: KeyboardEvent) => this.key(event) },
      this.spacer,
    );
    this.spacer.append(this.body);
    this.only.addEventListener("change", () => this.update());
    const names = ["object a", "", "object b", "", "kind"].map((name) => h("span", {}, name));
    this.element = h(
      "div", { class: "contacts" },
      h("div", { class: "table-top" }, this.summary, h("label", { title: "Only contacts of the selected object" }, this.only, "Selected object")),
      h("div", { class: "row head", "aria-hidden": "true" }, ...names),
      this.viewport,
    );
    model.on("frame", () => this.update());
    model.on("scene", () => this.update());
    model.on("selection", () => (this.only.checked ? this.update() : this.draw()));
    new ResizeObserver(() => this.draw()).observe(this.viewport);
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
    const text = frame ? `${readable(this.count)} contacts · ${readable(frame.objectPairs.length / 2)} object pairs` : "";
    if (this.summary.textContent !== text) this.summary.textContent = text;
    this.viewport.setAttribute("aria-rowcount", String(this.count));
    this.spacer.style.height = `${Math.min(HIGHEST, this.count * ROW)}px`;
    this.draw();
  }

  /** The first row in sight: of more rows than fit a scroll bar, in proportion. */
  private firstRow(): number {
    const { scrollTop, clientHeight } = this.viewport;
    const high = this.count * ROW;
    if (high <= HIGHEST) return Math.floor(scrollTop / ROW);
    const part = scrollTop / Math.max(1, HIGHEST - clientHeight);
    return Math.floor((part * (high - clientHeight)) / ROW);
  }

  private draw(): void {
    const { clientHeight, scrollTop } = this.viewport;
    if (clientHeight === 0) return;
    const first = this.firstRow();
    const shown = Math.max(0, Math.min(Math.ceil(clientHeight / ROW) + 1, this.count - first));
    while (this.rows.length < shown) this.addRow();
    const exact = this.count * ROW <= HIGHEST;
    this.body.style.transform = `translateY(${exact ? first * ROW : scrollTop}px)`;
    this.rows.forEach((row, i) => {
      row.hidden = i >= shown;
      if (i < shown) this.fillRow(row, first + i);
    });
  }

  private addRow(): void {
    const cells = Array.from({ length: 5 }, () => h("span", { role: "gridcell" }));
    const row = h("div", { class: "row", role: "row" }, ...cells);
    row.addEventListener("click", () => this.choose(Number(row.dataset["row"])));
    this.rows.push(row);
    this.body.append(row);
  }

  private fillRow(row: HTMLElement, index: number): void {
    const frame = this.model.frame!;
    const place = this.listed ? this.listed[index]! : index;
    const key = keyAt(frame, place);
    const sides = sidesOf(key).flatMap(({ object, elements }) => [this.model.objects[object]!.name, elements.join("–")]);
    const texts = [...sides, kindAt(frame, place)];
    texts.forEach((text, i) => {
      const cell = row.children[i]!;
      if (cell.textContent !== text) cell.textContent = text;
    });
    row.dataset["row"] = String(index);
    row.setAttribute("aria-rowindex", String(index + 1));
    const { contact } = this.model;
    const selected = contact !== null && contact.length === key.length && contact.every((id, i) => id === key[i]);
    row.setAttribute("aria-selected", String(selected));
  }

  private choose(index: number): void {
    if (!(index >= 0 && index < this.count)) return;
    const place = this.listed ? this.listed[index]! : index;
    this.model.selectContact(keyAt(this.model.frame!, place));
    this.reveal(index);
    this.fly();
  }

  private reveal(index: number): void {
    const { scrollTop, clientHeight } = this.viewport;
    const high = this.count * ROW;
    if (high > HIGHEST) {
      this.viewport.scrollTop = (index / this.count) * (HIGHEST - clientHeight);
      return;
    }
    if (index * ROW < scrollTop) this.viewport.scrollTop = index * ROW;
    else if ((index + 1) * ROW > scrollTop + clientHeight) this.viewport.scrollTop = (index + 1) * ROW - clientHeight;
  }

  private key(event: KeyboardEvent): void {
    const page = Math.max(1, Math.floor(this.viewport.clientHeight / ROW) - 1);
    const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity };
    const step = steps[event.key];
    if (step === undefined || this.count === 0) return;
    event.preventDefault();
    event.stopPropagation();
    const now = this.chosenRow();
    const next = now < 0 ? (step > 0 && step < Infinity ? 0 : step === Infinity ? this.count - 1 : 0) : now + step;
    this.choose(Math.max(0, Math.min(this.count - 1, next)));
  }

  private chosenRow(): number {
    const { contact, frame } = this.model;
    if (!contact || !frame) return -1;
    const place = findContact(frame, contact);
    return this.listed ? this.listed.indexOf(place) : place;
  }
}
