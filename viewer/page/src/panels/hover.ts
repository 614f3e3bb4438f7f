/** What is below the resting pointer: the surface or the mark, with its values in the newest frame. */
import { pointsOf, selectableIn, shareOfMargins } from "../contacts";
import { readField, titleOf } from "../fields/fields";
import type { Model } from "../model";
import { formOf, type Rows } from "../protocol/lists";
import { hasColumn, kindAt, numberAt, objectAt, SIDES, sidesAt, vectorAt, type ElementKind } from "../records";
import type { Hit } from "../view/picking";
import type { MarkHit, Pointing } from "../view/pointing";
import { styleOf } from "../view/styles";
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

/** What readers call some columns. */
const NAMES: Record<string, string> = { distance: "gap", toi: "time in step" };
const nameOf = (kind: ElementKind): string => (kind === "face" ? "triangle" : kind);

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

  /** The objects, what the row is, its elements, and its numbers with their units. */
  private ofMark({ list, place }: MarkHit): [string, Line[]] {
    const frame = this.model.frame!;
    const rows: Rows = frame.lists[list];
    if (rows === selectableIn(frame)) return this.ofContact(rows, place);
    const { words, joins, hidesElements } = styleOf(list);
    const lines: Line[] = [["kind", words?.[1] ?? (hasColumn(list, "kind") ? `${kindAt(rows, place)} ${formOf(list).item}` : kindAt(rows, place))]];
    for (const { kind, elements } of (!hidesElements && sidesAt(rows, place)) || []) lines.push([nameOf(kind), elements.join("–")]);
    for (const { name, scalar, width, unit, is_position } of [...formOf(list).columns].sort((p, q) => p.width - q.width)) {
      if (scalar !== "float32" || is_position || name === "normal") continue;
      const value = width === 1 ? numberAt(rows, name, place)! : Math.hypot(...vectorAt(rows, name, place));
      lines.push([`${NAMES[name] ?? name.replace(/_/g, " ")}${unit && ` (${unit})`}`, rounded(value)]);
    }
    if (hasColumn(list, "distance")) lines.push(["of margins", `${Math.round(100 * shareOfMargins(this.model.scene!, rows, place))} %`]);
    if (hasColumn(list, "normal")) lines.push(["normal", vector(vectorAt(rows, "normal", place))]);
    return [SIDES.map((side) => this.nameOf(objectAt(rows, side, place))).join(` ${joins ?? "and"} `), lines];
  }

  private ofContact(rows: Rows, place: number): [string, Line[]] {
    const lines: Line[] = sidesAt(rows, place)!.map(({ object, kind, elements }) => [this.nameOf(object), `${nameOf(kind)} ${elements.join("–")}`]);
    const [point] = pointsOf(this.model.frame!, this.model.objects, rows, place);
    lines.push(["at", this.placeOf(point!)], ["normal", vector(vectorAt(rows, "normal", place))]);
    if (hasColumn(rows.list, "toi")) lines.push([NAMES["toi"]!, rounded(numberAt(rows, "toi", place)!)]);
    return [`Contact: ${kindAt(rows, place)}`, lines];
  }
}
