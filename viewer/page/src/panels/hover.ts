/** What is below the resting pointer: the surface or the mark, with its values in the newest frame. */
import { hasImpacts, keyAt, kindAt, pointsAt, sidesOf } from "../contacts";
import { readField, titleOf } from "../fields/fields";
import type { Model } from "../model";
import type { Hit } from "../view/picking";
import type { MarkHit, Pointing } from "../view/pointing";
import { h, readable } from "./dom";

const REST_MILLISECONDS = 150;
const PRESS_MILLISECONDS = 500;
/** A finger that moves farther scrolls or turns. In CSS pixels. */
const STILL_PIXELS = 8;
/** Interval between updates while things move, if finding what is there takes less than this. */
const REFRESH_MILLISECONDS = 300;
const QUICK_MILLISECONDS = 20;
const APART = 14;

type Line = [name: string, value: string];

const rounded = (value: number): string => readable(Number(value.toPrecision(5)));
const vector = (numbers: ArrayLike<number>): string => Array.from(numbers, (x) => readable(Number(x.toPrecision(4)))).join(", ");

export class Hover {
  readonly element = h("div", { class: "hover", role: "tooltip", hidden: true });
  private at: { x: number; y: number } | null = null;
  private due: ReturnType<typeof setTimeout> | undefined;
  private shownAt = 0;
  private isQuick = true;

  constructor(canvas: HTMLElement, private readonly model: Model, private readonly pointing: Pointing) {
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointerup", (event) => event.pointerType === "mouse" || clearTimeout(this.due));
    for (const type of ["pointerleave", "pointercancel", "wheel", "blur"] as const) canvas.addEventListener(type, (event) => this.leave(event), { passive: true });
    document.addEventListener("keydown", () => this.hide());
    model.on("frame", () => this.refresh());
    model.on("scene", () => this.hide());
  }

  private move(event: PointerEvent): void {
    if (event.pointerType === "touch") {
      if (this.at && Math.hypot(event.clientX - this.at.x, event.clientY - this.at.y) > STILL_PIXELS) this.hide();
      return;
    }
    if (this.at?.x === event.clientX && this.at.y === event.clientY) return;
    this.hide();
    if (event.buttons === 0) this.wait(event, REST_MILLISECONDS);
  }

  private press(event: PointerEvent): void {
    this.hide();
    if (event.pointerType === "touch" && event.isPrimary) this.wait(event, PRESS_MILLISECONDS);
  }

  /** A finger leaves when it is lifted; what it has shown stays until the next touch. */
  private leave(event: Event): void {
    if (event instanceof PointerEvent && event.pointerType === "touch" && event.type === "pointerleave") return clearTimeout(this.due);
    this.hide();
  }

  private wait({ clientX: x, clientY: y }: PointerEvent, milliseconds: number): void {
    if (!this.model.hover) return;
    this.at = { x, y };
    this.due = setTimeout(() => this.show(), milliseconds);
  }

  hide(): void {
    clearTimeout(this.due);
    this.at = null;
    this.element.hidden = true;
  }

  private refresh(): void {
    if (this.element.hidden || !this.isQuick || performance.now() < this.shownAt + REFRESH_MILLISECONDS) return;
    this.show();
  }

  private show(): void {
    if (!this.at || !this.model.frame) return;
    const begin = performance.now();
    const { x, y } = this.at;
    const mark = this.pointing.markAt(x, y);
    const hit = mark ? null : this.pointing.pickAt(x, y);
    this.shownAt = performance.now();
    this.isQuick = this.shownAt - begin < QUICK_MILLISECONDS;
    const content = mark ? this.ofMark(mark) : hit ? this.ofSurface(hit) : null;
    this.element.hidden = content === null;
    if (!content) return;
    const [title, lines] = content;
    this.element.replaceChildren(h("strong", {}, title), h("dl", {}, ...lines.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])));
    this.place(x, y);
  }

  /** Beside the pointer, within the window. */
  private place(x: number, y: number): void {
    const { offsetWidth: width, offsetHeight: height } = this.element;
    const left = x + APART + width < innerWidth ? x + APART : Math.max(4, x - APART - width);
    const top = y + APART + height < innerHeight ? y + APART : Math.max(4, y - APART - height);
    this.element.style.transform = `translate(${left}px, ${top}px)`;
  }

  private nameOf(object: number): string {
    return this.model.objects[object]!.name;
  }

  private placeOf(point: ArrayLike<number>): string {
    return vector(this.model.scene!.center.map((x, axis) => x + point[axis]!));
  }

  private ofSurface({ object, triangle, vertex, point }: Hit): [string, Line[]] {
    return [this.nameOf(object), [["triangle", String(triangle)], ["vertex", String(vertex)], ["at", this.placeOf(point)], ...this.fieldLines(object, triangle, vertex)]];
  }

  /** The value of the shown field at the triangle or the nearest vertex. */
  private fieldLines(object: number, triangle: number, vertex: number): Line[] {
    const data = readField(this.model);
    if (!data || data.form.element === "contact") return [];
    const place = data.form.element === "face" ? triangle : vertex;
    const value = data.values.get(object)?.[place] ?? NaN;
    const lines: Line[] = [[titleOf(data.form), Number.isFinite(value) ? rounded(value) : "no value"]];
    const components = data.vectors.get(object)?.subarray(3 * place, 3 * place + 3);
    if (components) lines.push([data.form.label, vector(components)]);
    return lines;
  }

  /** A name with the unit of a field. */
  private withUnit(name: string, field: string): string {
    const unit = this.model.scene!.fields.find(({ key }) => key === field)?.unit;
    return unit ? `${name} (${unit})` : name;
  }

  private ofMark({ kind, place }: MarkHit): [string, Line[]] {
    const frame = this.model.frame!;
    const from = 8 * place;
    if (kind === "proximity") {
      const [a, b] = frame.proximityPairs.subarray(2 * place);
      const row = frame.proximityPoints.subarray(from, from + 8);
      const apart = [0, 1, 2].map((axis) => (row[axis]! - row[4 + axis]!) / (row[3]! || 1));
      return [`${this.nameOf(a!)} and ${this.nameOf(b!)}`, [["kind", "near"], [this.withUnit("gap", "gap"), rounded(row[3]!)], ["of margins", `${Math.round(100 * row[7]!)} %`], ["normal", vector(apart)]]];
    }
    if (kind === "penetrations") {
      const [a, vertex, b, triangle] = frame.penetrations.subarray(4 * place);
      const row = frame.penetrationPoints.subarray(from, from + 8);
      const out = [0, 1, 2].map((axis) => (row[4 + axis]! - row[axis]!) / (row[3]! || 1));
      return [`${this.nameOf(a!)} in ${this.nameOf(b!)}`, [["kind", "vertex inside"], ["vertex", String(vertex)], ["triangle", String(triangle)], [this.withUnit("depth", "depth"), rounded(row[3]!)], ["normal", vector(out)]]];
    }
    if (kind === "curves") {
      const [a, b, word] = frame.curves.subarray(from);
      const row = frame.curvePoints.subarray(from, from + 8);
      return [`${this.nameOf(a!)} and ${this.nameOf(b!)}`, [["kind", `${this.model.scene!.kinds.curve[word!]} curve`], [this.withUnit("depth", "curve_depth"), rounded(row[3]!)], [this.withUnit("area", "curve_area"), rounded(row[7]!)], ["normal", vector(row.subarray(4, 7))]]];
    }
    return this.ofContact(place);
  }

  private ofContact(place: number): [string, Line[]] {
    const frame = this.model.frame!;
    const { kinds } = this.model.scene!;
    const sides = sidesOf(keyAt(frame, place), kinds);
    const { data, first } = pointsAt(frame, place);
    const row = data.subarray(8 * first, 8 * first + 8);
    const lines: Line[] = sides.map(({ object, elements, isFace }) => [this.nameOf(object), `${isFace ? "triangle" : elements.length > 1 ? "edge" : "vertex"} ${elements.join("–")}`]);
    lines.push(["at", this.placeOf(row)], ["normal", vector(row.subarray(4, 7))]);
    if (hasImpacts(frame)) lines.push(["time in step", rounded(row[3]!)]);
    return [`Contact: ${kindAt(frame, place, kinds)}`, lines];
  }
}
