/** A table of the curves of the frame and what they enclose. */
import type { Column } from "../../filter";
import type { Model } from "../../model";
import { h, readable } from "../dom";
import { makeRow, RowWindow, type Row } from "./row_window";
import { TableControls } from "./table_controls";

const ROW_HEIGHT = 1.5;  // in rem
const rounded = (value: number): string => String(Number(value.toPrecision(3)));

export class CurveTable {
  readonly element: HTMLElement;
  private readonly summary = h("p", { class: "hint", "aria-live": "off" });
  private readonly window: RowWindow<Row>;
  private readonly controls: TableControls<number>;
  /** The numbers of the listed curves in the frame. */
  private listed: number[] = [];
  /** A curve of this step only: curves have no identity from step to step. */
  private chosen = -1;
  private state = "";

  constructor(private readonly model: Model, private readonly flyTo: (point: number[], reach: number) => void) {
    this.window = new RowWindow(
      { class: "table-view", role: "grid", "aria-label": "Curves", tabindex: 0, onkeydown: (event: KeyboardEvent) => this.key(event) },
      h("div", { class: "rows" }), ROW_HEIGHT, () => makeRow(5, (row) => this.choose(row), (row, cells, index) => this.showRow(row, cells, index)),
    );
    this.controls = new TableControls(this.columns(), ["area", "depth", "enclosed"], "curves", this.window.element, () => this.update());
    this.element = h(
      "div", { class: "contacts curves" },
      h("div", { class: "table-top" }, this.controls.field, this.summary), this.controls.refusal, this.controls.head, this.window.element,
    );
    model.on("scene", () => this.update());
    model.on("frame", () => this.update());
  }

  private columns(): Column<number>[] {
    const ids = (curve: number, at: number) => this.model.frame!.curves[8 * curve + at]!;
    const points = (curve: number, at: number) => this.model.frame!.curvePoints[8 * curve + at]!;
    const name = (curve: number, side: number) => this.model.objects[ids(curve, side)]!.name;
    return [
      { key: "a", label: "object a", value: (curve) => name(curve, 0) },
      { key: "b", label: "object b", value: (curve) => name(curve, 1) },
      { key: "area", label: "area", title: "Area of a closed curve, or the kind of the curve", value: (curve) => (this.kindOf(curve) === "closed" ? points(curve, 7) : null) },
      { key: "depth", label: "depth", title: "How far a must move along the normal", value: (curve) => points(curve, 3) },
      { key: "enclosed", label: "enclosed", title: "Vertices of a and of b that the curve encloses", value: (curve) => ids(curve, 5) + ids(curve, 6) },
      { key: "kind", value: (curve) => this.kindOf(curve) },
    ];
  }

  private kindOf(curve: number): string {
    return this.model.scene!.kinds.curve[this.model.frame!.curves[8 * curve + 2]!]!;
  }

  private update(): void {
    const { generation, step } = this.model.frame?.text ?? {};
    const state = `${generation} ${step}`;
    if (state !== this.state) this.chosen = -1;
    this.state = state;
    const { scene, frame } = this.model;
    const count = (frame?.curves.length ?? 0) / 8;
    this.listed = this.controls.apply(Array.from({ length: count }, (_, i) => i));
    const finds = scene?.contacts.includes("penetration") ?? false;
    const curves = `${readable(count)} ${count === 1 ? "curve" : "curves"}`;
    const listed = this.controls.isFiltered ? `${readable(this.listed.length)} of ${curves}` : curves;
    const text = finds ? listed : "Only scenes with the contacts “penetration” have curves (Settings).";
    this.controls.field.hidden = !finds;
    if (this.summary.textContent !== text) this.summary.textContent = text;
    this.window.element.setAttribute("aria-rowcount", String(this.listed.length));
    this.window.setCount(this.listed.length);
  }

  private showRow(row: HTMLElement, cells: HTMLElement[], index: number): void {
    const curve = this.listed[index]!;
    const { curves, curvePoints } = this.model.frame!;
    const [a, b, , , , countA, countB] = curves.subarray(8 * curve, 8 * curve + 8);
    const [depth, area] = [curvePoints[8 * curve + 3]!, curvePoints[8 * curve + 7]!];
    const names = [a!, b!].map((object) => this.model.objects[object]!.name);
    const word = this.kindOf(curve);
    const texts = [...names, word === "closed" ? rounded(area) : word, rounded(depth), `${countA} + ${countB}`];
    texts.forEach((text, i) => {
      if (cells[i]!.textContent !== text) cells[i]!.textContent = text;
    });
    row.setAttribute("aria-rowindex", String(index + 1));
    row.setAttribute("aria-selected", String(curve === this.chosen));
  }

  private choose(index: number): void {
    const curve = this.listed[index];
    if (curve === undefined) return;  // it has disappeared meanwhile
    this.chosen = curve;
    this.window.reveal(index);
    this.window.draw();
    const [x, y, z, depth, , , , area] = this.model.frame!.curvePoints.subarray(8 * curve, 8 * curve + 8);
    this.flyTo([x!, y!, z!], Math.max(depth!, Math.sqrt(area!)));
  }

  private key(event: KeyboardEvent): void {
    const next = this.window.rowAfter(event.key, this.listed.indexOf(this.chosen));
    if (next === null) return;
    event.preventDefault();
    event.stopPropagation();
    this.choose(next);
  }
}
