/** The colour bar: which colour stands for which value. The same function draws it over the view and in pictures. */
import { canvasPen, type Pen, type Text } from "../capture/pen";
import type { Model } from "../model";
import { h, remPixels } from "../panels/dom";
import { colourAt, MAP_COLOURS, type MapName } from "./colour_maps";
import { rangeOf, readField, tickText, titleOf } from "./fields";

export interface Bar {
  /** What the values are, with their unit. */
  title: string;
  map: MapName;
  low: number;
  high: number;
  /** A line below the numbers, or empty. */
  note: string;
}

/** Where and how to draw a bar, in the units of the pen. */
export interface BarPlace {
  x: number;
  y: number;
  width: number;
  /** The size of the font; all other sizes follow from it. */
  fontSize: number;
  ink: string;
  /** Surrounds the letters; null for none. */
  halo: string | null;
}

/** The bar of the chosen field; null when there is none. */
export function barOf(model: Model): Bar | null {
  const data = readField(model);
  if (!data) return null;
  const { key, element } = data.form;
  const [low, high] = rangeOf(data, model.field);
  const isEmpty = !(data.lowest <= data.highest);
  const note = isEmpty ? emptyNote(key, element) : data.hasGaps && element !== "contact" ? "Without a value: the object’s colour" : "";
  return { title: titleOf(data.form), map: model.field.map, low, high, note };
}

function emptyNote(key: string, element: string): string {
  if (key === "speed" || key === "velocity") return "No values yet: they need the step before";
  return element === "contact" ? "No values: there are no such contacts" : "No values in this frame";
}

const tickCount = (width: number, fontSize: number): number => (width >= 18 * fontSize ? 5 : 3);

/** The values at the ticks, as text. */
export function ticksOf({ low, high }: Pick<Bar, "low" | "high">, count: number): string[] {
  if (!(high > low)) return [tickText(low, 0)];
  const step = (high - low) / (count - 1);
  return Array.from({ length: count }, (_, i) => tickText(i === count - 1 ? high : low + i * step, step));
}

/** The height of a bar in a font of this size. */
export const barHeight = ({ note }: Pick<Bar, "note">, fontSize: number): number => (note ? 5.1 : 3.7) * fontSize;

/** Draws a title, the colours, numbers and a note below one another. */
export function drawColourBar(pen: Pen, { x, y, width, fontSize, ink, halo }: BarPlace, bar: Bar): void {
  const write = (at: number, below: number, text: string, align: Text["align"] = "start") => pen.text(at, y + below * fontSize, text, { size: fontSize, colour: ink, halo, align });
  const top = y + 1.4 * fontSize;
  const height = 0.8 * fontSize;
  write(x, 0.9, bar.title);
  for (let i = 0; i < MAP_COLOURS; ++i) {
    const left = x + (i * width) / MAP_COLOURS;
    // Overlaps the next one, so that no gap shines through.
    pen.box(left, top, i < MAP_COLOURS - 1 ? (1.5 * width) / MAP_COLOURS : x + width - left, height, `rgb(${colourAt(bar.map, i / (MAP_COLOURS - 1)).join(" ")})`, null);
  }
  pen.box(x, top, width, height, "none", ink);
  const ticks = ticksOf(bar, tickCount(width, fontSize));
  ticks.forEach((text, i) => {
    const at = ticks.length > 1 ? i / (ticks.length - 1) : 0;
    pen.box(x + at * (width - 1), top + height, 1, 0.25 * fontSize, ink, null);
    write(x + at * width, 3.4, text, at === 0 ? "start" : at === 1 ? "end" : "middle");
  });
  if (bar.note) write(x, 4.8, bar.note);
}

/** The bar over the view. */
export class ColourBar {
  readonly canvas = h("canvas", { role: "img" });
  readonly element = h("div", { class: "colour-bar", hidden: true }, this.canvas);
  private drawn = "";

  constructor(private readonly model: Model) {
    for (const event of ["scene", "frame", "display"] as const) model.on(event, () => this.update());
    new ResizeObserver(() => this.update()).observe(document.body);
  }

  /** Call also when the theme has changed. */
  update(): void {
    const bar = barOf(this.model);
    this.element.hidden = bar === null;
    if (!bar) return;
    const rem = remPixels();
    const { color: ink } = getComputedStyle(this.element);
    const width = Math.min(18 * rem, document.body.clientWidth - 4 * rem);
    const drawn = JSON.stringify([bar, rem, ink, width, devicePixelRatio]);
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    const fontSize = 0.78 * rem;
    const height = barHeight(bar, fontSize);
    const { canvas } = this;
    [canvas.width, canvas.height] = [width, height].map((size) => Math.ceil(size * devicePixelRatio)) as [number, number];
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    const context = canvas.getContext("2d")!;
    drawColourBar(canvasPen(context, devicePixelRatio), { x: 1, y: 0, width: width - 2, fontSize, ink, halo: null }, bar);
    const [low, high] = [ticksOf(bar, 5)[0]!, ticksOf(bar, 5).at(-1)!];
    canvas.setAttribute("aria-label", `Colour bar: ${bar.title} from ${low} to ${high}, ${bar.map}.${bar.note ? ` ${bar.note}.` : ""}`);
  }
}
