/** The pins with their present values, and the values of one of them over time. */
import type { Column } from "../../filter";
import type { Model } from "../../model";
import { titleOf, type Pin, type Pins } from "../../pins";
import { download, h, readable, stamp } from "../dom";
import { PinPlots } from "../plots/pin_plots";
import { makeRow, RowWindow, type Row } from "./row_window";
import { TableControls } from "./table_controls";

const ROW_HEIGHT = 1.5;  // in rem
const REDRAW_MILLISECONDS = 150;
const SHOWN = ["contacts", "gap", "depth"];
const rounded = (value: number): string => (Number.isNaN(value) ? "–" : Math.abs(value) >= 1000 ? readable(Math.round(value)) : String(Number(value.toPrecision(3))));

export class PinTable {
  readonly element: HTMLElement;
  private readonly controls: TableControls<Pin>;
  private readonly window: RowWindow<Row>;
  private readonly summary = h("p", { class: "hint", "aria-live": "off" });
  private readonly title = h("h3", {});
  private readonly state = h("p", { class: "hint", role: "status" });
  /** Of the frames of a recording that the session measures. */
  private readonly progress = h("progress", { "aria-label": "Frames of the recording that are measured", hidden: true });
  private readonly detail: HTMLElement;
  private readonly empty = h("p", { class: "hint empty" }, "Nothing is pinned. Select an object or a contact and press Pin in Inspect, or ", h("kbd", {}, "Shift"), " ", h("kbd", {}, "I"), "; pin a pair of objects from its row under Contacts.");
  private readonly plots: PinPlots;
  private listed: Pin[] = [];
  private chosen: Pin | null = null;
  private due: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly model: Model, private readonly pins: Pins, private readonly show: (pin: Pin) => void, seek: (step: number) => void) {
    this.window = new RowWindow(
      { class: "table-view", role: "grid", "aria-label": "Pins", tabindex: 0, onkeydown: (event: KeyboardEvent) => this.key(event) },
      h("div", { class: "rows" }), ROW_HEIGHT, () => makeRow(1 + SHOWN.length, (row) => this.choose(row), (row, cells, index) => this.showRow(row, cells, index)),
    );
    const columns: Column<Pin>[] = [
      { key: "pin", label: "pin", value: titleOf },
      ...SHOWN.map((key): Column<Pin> => ({ key, label: key, value: (pin) => this.present(pin, key) })),
      ...["length", "area", "impact_time", "speed", "displacement"].map((key): Column<Pin> => ({ key, value: (pin) => this.present(pin, key) })),
    ];
    this.controls = new TableControls(columns, columns.slice(1).map(({ key }) => key), "pins", this.window.element, () => this.update());
    this.plots = new PinPlots(model, seek);
    const button = (label: string, title: string, press: (pin: Pin) => void) => h("button", { type: "button", class: "link", title, onclick: () => this.chosen && press(this.chosen) }, label);
    this.detail = h(
      "div", { class: "pin-detail" },
      h("div", { class: "pin-title" }, this.title, h("span", { class: "links" },
        button("show", "Select it and fly to it", (pin) => this.show(pin)), button("save CSV", "All values of all steps that the page has", (pin) => this.save(pin)), button("unpin", "Follow it no longer", (pin) => pins.remove(pin)))),
      this.state, this.progress, this.plots.element,
    );
    this.element = h("div", { class: "contacts pins" }, h("div", { class: "table-top" }, this.controls.field, this.summary), this.controls.refusal, this.controls.head, this.window.element, this.empty, this.detail);
    pins.on("list", (pin) => {
      if (pin) this.chosen = pin;
      this.update();
    });
    pins.on("rows", () => this.later());
    model.on("frame", () => this.later());
    this.update();
  }

  /** With the colours of the theme. */
  rebuild(): void {
    this.plots.rebuild();
  }

  private present(pin: Pin, key: string): number | null {
    const value = pin.series.at(this.pins.names.indexOf(key), this.model.frame?.text.step ?? -1);
    return Number.isNaN(value) ? null : value;
  }

  private later(): void {
    this.due ??= setTimeout(() => {
      this.due = undefined;
      this.update();
    }, REDRAW_MILLISECONDS);
  }

  private update(): void {
    const { list } = this.pins;
    if (!this.chosen || !list.includes(this.chosen)) this.chosen = list.at(-1) ?? null;
    this.empty.hidden = list.length > 0;
    for (const element of [this.controls.field, this.controls.head, this.window.element, this.detail]) element.hidden = list.length === 0;
    this.listed = this.controls.apply(list);
    const count = `${list.length} ${list.length === 1 ? "pin" : "pins"}`;
    const text = list.length === 0 ? "" : this.controls.isFiltered ? `${this.listed.length} of ${count}` : count;
    if (this.summary.textContent !== text) this.summary.textContent = text;
    this.window.element.setAttribute("aria-rowcount", String(this.listed.length));
    this.window.setCount(this.listed.length);
    if (this.chosen) this.showDetail(this.chosen);
  }

  private showDetail(pin: Pin): void {
    const title = titleOf(pin);
    if (this.title.textContent !== title) this.title.textContent = title;
    const state = this.stateOf(pin);
    if (this.state.textContent !== state) this.state.textContent = state;
    const frames = this.model.frame?.text.pin_frames;
    this.progress.hidden = !frames;
    if (frames) {
      [this.progress.value, this.progress.max] = frames;
      this.progress.title = `${readable(frames[0])} of ${readable(frames[1])} frames`;
    }
    this.plots.show(pin, this.pins.names);
  }

  /** What the numbers do not say. */
  private stateOf(pin: Pin): string {
    const { objects, scene } = this.model;
    const gone = pin.objects.find((object) => scene?.objects[object]?.removed);
    if (gone !== undefined) return `${objects[gone]!.name} was removed.`;
    const contacts = pin.series.columns[0] ?? [];
    const steps = `${readable(contacts.length)} ${contacts.length === 1 ? "step" : "steps"}`;
    if (contacts.length === 0) return "There are no values yet.";
    if (pin.objects.length > 1 && contacts.every((count) => !(count > 0))) return `No contact in ${steps}.`;
    if (pin.contact && this.present(pin, "contacts") === 0) return `No longer a contact.`;
    return `Values of ${steps}.`;
  }

  private showRow(row: HTMLElement, cells: HTMLElement[], index: number): void {
    const pin = this.listed[index]!;
    const texts = [titleOf(pin), ...SHOWN.map((key) => rounded(this.present(pin, key) ?? NaN))];
    texts.forEach((text, i) => {
      if (cells[i]!.textContent !== text) cells[i]!.textContent = text;
    });
    cells[0]!.title = texts[0]!;
    row.setAttribute("aria-rowindex", String(index + 1));
    row.setAttribute("aria-selected", String(pin === this.chosen));
  }

  private choose(index: number): void {
    const pin = this.listed[index];
    if (!pin) return;
    this.chosen = pin;
    this.window.reveal(index);
    this.update();
  }

  private key(event: KeyboardEvent): void {
    const at = this.chosen ? this.listed.indexOf(this.chosen) : -1;
    if (event.key === "Delete" && at >= 0) this.pins.remove(this.listed[at]!);
    else if (event.key === "Enter" && at >= 0) this.show(this.listed[at]!);
    else {
      const next = this.window.rowAfter(event.key, at);
      if (next === null) return;
      this.choose(next);
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private save(pin: Pin): void {
    const name = titleOf(pin).replace(/[^\p{L}\p{N}]+/gu, "-");
    download(new Blob([pin.series.csv(this.pins.names)], { type: "text/csv" }), `supple-${name}-${stamp()}.csv`);
  }
}
