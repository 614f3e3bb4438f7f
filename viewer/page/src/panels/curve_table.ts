/** A table of the curves of the frame and what they enclose. */
import type { Model } from "../model";
import { h, readable } from "./dom";
import { makeRow, RowWindow, type Row } from "./row_window";

const ROW_HEIGHT = 1.5;  // in rem
const rounded = (value: number): string => String(Number(value.toPrecision(3)));

export class CurveTable {
  readonly element: HTMLElement;
  private readonly summary = h("p", { class: "hint", "aria-live": "off" });
  private readonly window: RowWindow<Row>;
  /** A row of this step only: curves have no identity from step to step. */
  private chosen = -1;
  private state = "";

  constructor(private readonly model: Model, private readonly flyTo: (point: number[], reach: number) => void) {
    this.window = new RowWindow(
      { class: "table-view", role: "grid", "aria-label": "Curves", tabindex: 0, onkeydown: (event: KeyboardEvent) => this.key(event) },
      h("div", { class: "rows" }), ROW_HEIGHT, () => makeRow(5, (index) => this.choose(index), (row, cells, index) => this.showRow(row, cells, index)),
    );
    const heads: [string, string][] = [
      ["object a", ""], ["object b", ""], ["area", "Area of a closed curve, or the kind of the curve"],
      ["depth", "How far a must move along the normal"], ["enclosed", "Vertices of a and of b that the curve encloses"],
    ];
    this.element = h(
      "div", { class: "contacts curves" },
      h("div", { class: "table-top" }, this.summary),
      h("div", { class: "row head", "aria-hidden": "true" }, ...heads.map(([name, title]) => h("span", { title }, name))),
      this.window.element,
    );
    model.on("scene", () => this.update());
    model.on("frame", () => this.update());
  }

  private get count(): number {
    return (this.model.frame?.curves.length ?? 0) / 8;
  }

  private update(): void {
    const { generation, step } = this.model.frame?.text ?? {};
    const state = `${generation} ${step}`;
    if (state !== this.state) this.chosen = -1;
    this.state = state;
    const { scene } = this.model;
    const finds = scene?.contacts.includes("penetration") ?? false;
    const text = finds ? `${readable(this.count)} ${this.count === 1 ? "curve" : "curves"}` : "Only scenes with the contacts “penetration” have curves (Settings).";
    if (this.summary.textContent !== text) this.summary.textContent = text;
    this.window.element.setAttribute("aria-rowcount", String(this.count));
    this.window.setCount(this.count);
  }

  private showRow(row: HTMLElement, cells: HTMLElement[], index: number): void {
    const { curves, curvePoints } = this.model.frame!;
    const [a, b, kind, , , countA, countB] = curves.subarray(8 * index, 8 * index + 8);
    const [depth, area] = [curvePoints[8 * index + 3]!, curvePoints[8 * index + 7]!];
    const names = [a!, b!].map((object) => this.model.objects[object]!.name);
    const word = this.model.scene!.kinds.curve[kind!]!;
    const texts = [...names, word === "closed" ? rounded(area) : word, rounded(depth), `${countA} + ${countB}`];
    texts.forEach((text, i) => {
      if (cells[i]!.textContent !== text) cells[i]!.textContent = text;
    });
    row.setAttribute("aria-rowindex", String(index + 1));
    row.setAttribute("aria-selected", String(index === this.chosen));
  }

  private choose(index: number): void {
    if (index >= this.count) return;  // it has disappeared meanwhile
    this.chosen = index;
    this.window.reveal(index);
    this.window.draw();
    const [x, y, z, depth, , , , area] = this.model.frame!.curvePoints.subarray(8 * index, 8 * index + 8);
    this.flyTo([x!, y!, z!], Math.max(depth!, Math.sqrt(area!)));
  }

  private key(event: KeyboardEvent): void {
    const next = this.window.rowAfter(event.key, this.chosen);
    if (next === null) return;
    event.preventDefault();
    event.stopPropagation();
    this.choose(next);
  }
}
