/** A table of the curves of the frame and what they enclose. */
import type { Column } from "../../filter";
import type { Model } from "../../model";
import type { Rows } from "../../protocol/lists";
import { kindAt, numberAt, objectAt, SIDES, vectorAt, type Side } from "../../records";
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
    return [
      { key: "a", label: "object a", value: (curve) => this.nameOf(curve, "a") },
      { key: "b", label: "object b", value: (curve) => this.nameOf(curve, "b") },
      { key: "area", label: "area", title: "Area of a closed curve, or the kind of the curve", value: (curve) => (this.kindOf(curve) === "closed" ? this.areaOf(curve) : null) },
      { key: "depth", label: "depth", title: "How far a must move along the normal", value: (curve) => numberAt(this.curves, "depth", curve)! },
      { key: "enclosed", label: "enclosed", title: "Vertices of a and of b that the curve encloses", value: (curve) => numberAt(this.curves, "enclosed_count_a", curve)! + numberAt(this.curves, "enclosed_count_b", curve)! },
      { key: "kind", value: (curve) => this.kindOf(curve) },
    ];
  }

  private get curves(): Rows {
    return this.model.frame!.lists.curves;
  }

  private nameOf(curve: number, side: Side): string {
    return this.model.objects[objectAt(this.curves, side, curve)]!.name;
  }

  private kindOf(curve: number): string {
    return kindAt(this.curves, curve);
  }

  private areaOf(curve: number): number {
    return Math.hypot(...vectorAt(this.curves, "area", curve));
  }

  private update(): void {
    const { generation, step } = this.model.frame?.text ?? {};
    const state = `${generation} ${step}`;
    if (state !== this.state) this.chosen = -1;
    this.state = state;
    const { scene, frame } = this.model;
    const count = frame?.lists.curves.count ?? 0;
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
    const [depth, a, b] = ["depth", "enclosed_count_a", "enclosed_count_b"].map((name) => numberAt(this.curves, name, curve)!);
    const word = this.kindOf(curve);
    const texts = [
      ...SIDES.map((side) => this.nameOf(curve, side)), word === "closed" ? rounded(this.areaOf(curve)) : word, rounded(depth!), `${a} + ${b}`,
    ];
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
    this.flyTo(Array.from(vectorAt(this.curves, "centroid", curve)), Math.max(numberAt(this.curves, "depth", curve)!, Math.sqrt(this.areaOf(curve))));
  }

  private key(event: KeyboardEvent): void {
    const next = this.window.rowAfter(event.key, this.listed.indexOf(this.chosen));
    if (next === null) return;
    event.preventDefault();
    event.stopPropagation();
    this.choose(next);
  }
}
