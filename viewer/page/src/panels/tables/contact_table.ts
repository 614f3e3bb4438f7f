/** What touches what: a table of pairs of objects, each of which opens to its single contacts. */
import { findContact, isHit, isTouching, middleOf, pairsOf, pointsOf, selectableIn, type TouchingPair } from "../../contacts";
import type { Column } from "../../filter";
import type { Model } from "../../model";
import type { Pins } from "../../pins";
import type { ListName, Rows } from "../../protocol/lists";
import { hasColumn, keyAt, kindAt, numberAt, sidesAt } from "../../records";
import { styleOf } from "../../view/styles";
import { h, readable } from "../dom";
import { makeRow, RowWindow, type Row } from "./row_window";
import { TableControls } from "./table_controls";

const ROW_HEIGHT = 1.5;  // in rem
const rounded = (value: number): string => String(Number(value.toPrecision(3)));

/** The number of a row by which contacts are compared, with the word before it. */
const MEASURES = [["distance", "gap"], ["depth", "depth"], ["toi", "at"]] as const;

interface Single {
  list: ListName;
  place: number;
}

export class ContactTable {
  readonly element: HTMLElement;
  private readonly summary = h("p", { class: "hint", "aria-live": "off" });
  private readonly window: RowWindow<Row>;
  private readonly controls: TableControls<TouchingPair>;
  private readonly pinButton = h("button", { type: "button", class: "link", disabled: true, title: "Follow the chosen pair or contact over time (Shift+I)", onclick: () => this.pin() }, "pin");
  private listed: TouchingPair[] = [];
  /** The first row of each listed pair, and the number of rows. */
  private starts: number[] = [0];
  private readonly open = new Set<string>();
  /** The chosen pair and the number of the single contact in it, −1 for the pair itself. */
  private chosen: { pair: string; single: number } | null = null;

  constructor(private readonly model: Model, private readonly pins: Pins, private readonly flyTo: (point: number[], reach: number) => void) {
    this.window = new RowWindow(
      { class: "table-view", role: "treegrid", "aria-label": "Contacts", tabindex: 0, onkeydown: (event: KeyboardEvent) => this.key(event) },
      h("div", { class: "rows" }), ROW_HEIGHT, () => makeRow(4, (index) => this.press(index), (row, cells, index) => this.showRow(row, cells, index)),
    );
    this.controls = new TableControls(this.columns(), ["contacts", "gap", "depth", "time"], "contacts", this.window.element, () => this.setFilter(this.controls.field.value));
    this.element = h(
      "div", { class: "contacts pairs" },
      h("div", { class: "table-top" }, this.controls.field, this.pinButton, this.summary), this.controls.refusal, this.controls.head, this.window.element,
    );
    model.on("frame", () => this.update());
    model.on("scene", () => {
      this.open.clear();
      this.chosen = null;
      this.update();
    });
    model.on("selection", () => this.window.draw());
    model.on("display", () => this.controls.field.value !== model.filter && this.setFilter(model.filter));
  }

  private nameOf(object: number): string {
    return this.model.objects[object]!.name;
  }

  private columns(): Column<TouchingPair>[] {
    return [
      { key: "a", label: "object a", value: ({ a }) => this.nameOf(a) },
      { key: "b", label: "object b", value: ({ b }) => this.nameOf(b) },
      { key: "contacts", label: "contacts", title: "Contacts and near pairs of the two objects", value: ({ count }) => count },
      { key: "is", label: "gap or depth", title: "The smallest gap, the largest depth, or the time of the first hit as a part of the step", value: wordOf, rank: overlapOf },
      { key: "gap", value: ({ gap }) => gap }, { key: "depth", value: ({ depth }) => depth }, { key: "time", value: ({ time }) => time },
    ];
  }

  private setFilter(text: string): void {
    if (this.controls.field.value !== text) this.controls.field.value = text;
    this.model.filter = text;
    this.update();
  }

  private update(): void {
    const { frame } = this.model;
    const all = frame ? pairsOf(frame) : [];
    this.listed = this.controls.apply(all);
    this.starts = [0];
    for (const pair of this.listed) this.starts.push(this.starts.at(-1)! + 1 + (this.open.has(keyOf(pair)) ? pair.count : 0));
    const pairs = `${readable(all.length)} ${all.length === 1 ? "pair" : "pairs"}`;
    const text = !this.controls.isFiltered ? pairs : `${readable(this.listed.length)} of ${pairs}`;
    if (this.summary.textContent !== text) this.summary.textContent = text;
    this.pinButton.disabled = this.chosenRow() < 0;
    this.window.element.setAttribute("aria-rowcount", String(this.count));
    this.window.setCount(this.count);
  }

  private get count(): number {
    return this.starts.at(-1)!;
  }

  /** The pair of a row, and the number of the single contact in it; −1 for the row of the pair. */
  private at(row: number): { pair: TouchingPair; single: number } {
    let [low, high] = [0, this.listed.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.starts[middle]! <= row) low = middle;
      else high = middle - 1;
    }
    return { pair: this.listed[low]!, single: row - this.starts[low]! - 1 };
  }

  private showRow(row: HTMLElement, cells: HTMLElement[], index: number): void {
    const { pair, single } = this.at(index);
    const isPair = single < 0;
    const isOpen = this.open.has(keyOf(pair));
    const texts = isPair
      ? [`${isOpen ? "▾" : "▸"} ${this.nameOf(pair.a)}`, pair.a === pair.b ? "itself" : this.nameOf(pair.b), readable(pair.count), measureOf(pair)]
      : this.textsOf(singleOf(pair, single));
    texts.forEach((text, i) => {
      if (cells[i]!.textContent !== text) cells[i]!.textContent = text;
    });
    row.classList.toggle("single", !isPair);
    row.setAttribute("aria-rowindex", String(index + 1));
    row.setAttribute("aria-level", isPair ? "1" : "2");
    if (isPair) row.setAttribute("aria-expanded", String(isOpen));
    else row.removeAttribute("aria-expanded");
    row.setAttribute("aria-selected", String(index === this.chosenRow()));
  }

  /** What touches in a single contact: an element of each side, the kind, and a number. */
  private textsOf({ list, place }: Single): string[] {
    const rows: Rows = this.model.frame!.lists[list];
    const { words, hidesElements } = styleOf(list);
    const sides = (!hidesElements && sidesAt(rows, place)) || null;
    const measure = MEASURES.find(([column]) => hasColumn(list, column));
    return [
      ...(sides?.map(({ kind, elements }) => `${kind} ${elements.join("–")}`) ?? ["", ""]),
      words?.[0] ?? kindAt(rows, place), measure ? `${measure[1]} ${rounded(numberAt(rows, measure[0], place)!)}` : "",
    ];
  }

  /** A click on a pair shows it and opens it, or closes it again. */
  private press(index: number): void {
    if (index >= this.count) return;  // it has disappeared meanwhile
    const { pair, single } = this.at(index);
    if (single < 0 && this.open.delete(keyOf(pair))) return this.update();
    if (single < 0) this.open.add(keyOf(pair));
    this.choose(index);
    this.update();
  }

  private choose(index: number): void {
    const { pair, single } = this.at(index);
    const frame = this.model.frame!;
    this.chosen = { pair: keyOf(pair), single };
    this.window.reveal(index);
    const from = single < 0 ? null : singleOf(pair, single);
    if (from?.list === selectableIn(frame).list) this.model.selectContact(keyAt(selectableIn(frame), from.place));
    else this.model.select({ object: pair.a, triangle: null, vertex: null });
    const singles = from ? [from] : pair.runs.flatMap(({ list, first, count }) => Array.from({ length: count }, (_, i) => ({ list, place: first + i })));
    const middles = singles.map(({ list, place }) => middleOf(pointsOf(frame, this.model.objects, frame.lists[list], place)));
    this.showPoints(middles.filter((point) => point !== null));
    this.pinButton.disabled = false;
    this.window.draw();
  }

  private showPoints(points: number[][]): void {
    if (points.length === 0) return;
    const [lower, upper] = [[0, 1, 2].map((axis) => Math.min(...ends(points, axis))), [0, 1, 2].map((axis) => Math.max(...ends(points, axis)))];
    const middle = lower.map((x, axis) => (x + upper[axis]!) / 2);
    this.flyTo(middle, Math.hypot(...upper.map((x, axis) => x - lower[axis]!)) / 2);
  }

  /** Pins the chosen contact, or the pair: also for rows that only a pair has, such as gaps. */
  private pin(): void {
    const now = this.chosenRow();
    if (now < 0) return;
    const { pair, single } = this.at(now);
    this.pins.add([pair.a, pair.b], single < 0 ? null : this.model.contact);
  }

  private key(event: KeyboardEvent): void {
    const now = this.chosenRow();
    const pair = now >= 0 ? this.at(now).pair : null;
    if (event.shiftKey && event.key.toUpperCase() === "I" && pair) {
      event.preventDefault();
      event.stopPropagation();
      return this.pin();
    }
    if (pair && (event.key === "ArrowRight" || event.key === "ArrowLeft" || event.key === "Enter")) {
      const isOpen = this.open.has(keyOf(pair));
      if (isOpen && event.key !== "ArrowRight") this.open.delete(keyOf(pair));
      else if (!isOpen && event.key !== "ArrowLeft") this.open.add(keyOf(pair));
      if (!this.open.has(keyOf(pair))) this.chosen = { pair: keyOf(pair), single: -1 };
      this.update();
    } else {
      const next = this.window.rowAfter(event.key, now);
      if (next === null) return;
      this.choose(next);
    }
    event.preventDefault();
    event.stopPropagation();
  }

  /** The chosen row, or that of the selected contact; −1 when it is not listed. */
  private chosenRow(): number {
    const { chosen } = this;
    const { contact, frame } = this.model;
    if (!chosen || !frame) return -1;
    const at = this.listed.findIndex((pair) => keyOf(pair) === chosen.pair);
    if (at < 0) return -1;
    if (chosen.single < 0 || !this.open.has(chosen.pair)) return this.starts[at]!;
    const pair = this.listed[at]!;
    const place = contact ? findContact(frame, contact) : -1;  // contacts keep their elements from step to step, not their place
    const single = place >= 0 ? numberOf(pair, selectableIn(frame).list, place) : chosen.single;
    return single < pair.count ? this.starts[at]! + 1 + single : this.starts[at]!;
  }
}

const keyOf = ({ a, b }: TouchingPair): string => `${a} ${b}`;

/** At most this many points decide how much is shown of a pair. */
const MOST_POINTS = 10_000;
const ends = (points: number[][], axis: number): number[] => points.slice(0, MOST_POINTS).map((point) => point[axis]!);

const wordOf = (pair: TouchingPair): string => (isTouching(pair) ? "touching" : isHit(pair) ? "hit" : "near");

/** Deeper pairs have more, pairs that are farther apart less: depths, then intersections, hits and gaps. */
function overlapOf(pair: TouchingPair): number {
  if (pair.depth !== null) return 1 + pair.depth;
  if (isTouching(pair)) return 1;
  if (isHit(pair)) return 1 - pair.time! / 2;
  return -pair.gap!;
}

function measureOf(pair: TouchingPair): string {
  if (pair.depth !== null) return `depth ${rounded(pair.depth)}`;
  if (isTouching(pair)) return "intersect";
  if (isHit(pair)) return `hit at ${rounded(pair.time!)}`;
  return `gap ${rounded(pair.gap!)}`;
}

function singleOf(pair: TouchingPair, number: number): Single {
  let left = number;
  for (const { list, first, count } of pair.runs) {
    if (left < count) return { list, place: first + left };
    left -= count;
  }
  throw new Error("a pair has fewer contacts");
}

/** The number of a single contact in its pair; −1 when it is in another one. */
function numberOf(pair: TouchingPair, list: ListName, place: number): number {
  let before = 0;
  for (const run of pair.runs) {
    if (run.list === list && place >= run.first && place < run.first + run.count) return before + place - run.first;
    before += run.count;
  }
  return -1;
}
