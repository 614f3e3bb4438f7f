/** The legend, the colour bar and the scale bar of a picture, drawn in the same way by the dialog and by `supple render`. */
import { barHeight, drawColourBar, type Bar } from "../fields/colour_bar";
import type { ObjectState } from "../model";
import { readable } from "../panels/dom";
import { niceStep } from "../view/world";
import type { Pen, Text } from "./pen";

/** In CSS pixels, of which 96 are an inch: texts have 9 points. */
const MARGIN = 12;
const TEXT_SIZE = 12;
const LINE = 18;
const SWATCH = 11;
const BAR_WIDTH = 220;
/** The part of the height that a legend may fill. */
const MOST_OF_HEIGHT = 0.7;

export interface Overlay {
  /** The size of the picture. */
  width: number;
  height: number;
  ink: string;
  halo: string | null;
  /** The objects of the legend; null for no legend. */
  objects: Pick<ObjectState, "name" | "colour">[] | null;
  scale: Scale | null;
  /** The colours of a field. */
  bar: Bar | null;
}

export interface Scale {
  /** The length in the scene that a CSS pixel covers, at the target of the camera. */
  perPixel: number;
  unit: string;
  /** In perspective the length is right only at the distance of the target. */
  isPerspective: boolean;
}

function drawLegend(pen: Pen, objects: Pick<ObjectState, "name" | "colour">[], height: number, text: Text): void {
  const most = Math.max(1, Math.floor((MOST_OF_HEIGHT * height - MARGIN) / LINE));
  const shown = objects.length <= most ? objects : objects.slice(0, most - 1);
  shown.forEach(({ name, colour }, i) => {
    const y = MARGIN + i * LINE;
    pen.box(MARGIN, y, SWATCH, SWATCH, colour, text.colour);
    pen.text(MARGIN + SWATCH + 7, y + SWATCH - 1, name, text);
  });
  const rest = objects.length - shown.length;
  if (rest > 0) pen.text(MARGIN, MARGIN + shown.length * LINE + SWATCH - 1, `and ${readable(rest)} more`, text);
}

function drawScale(pen: Pen, { perPixel, unit, isPerspective }: Scale, width: number, height: number, text: Text): void {
  const length = niceStep(width * perPixel);
  const pixels = length / perPixel;
  const y = height - MARGIN - 4;
  pen.box(width - MARGIN - pixels, y, pixels, 4, text.colour, text.halo);
  const words = [readable(Number(length.toPrecision(6))), unit, isPerspective ? "(at the target)" : ""];
  pen.text(width - MARGIN, y - 6, words.filter(Boolean).join(" "), { ...text, align: "end" });
}

export function drawOverlay(pen: Pen, { width, height, ink, halo, objects, scale, bar }: Overlay): void {
  const text: Text = { size: TEXT_SIZE, colour: ink, halo, align: "start" };
  if (objects) drawLegend(pen, objects, height, text);
  if (scale) drawScale(pen, scale, width, height, text);
  if (bar) {
    const y = height - MARGIN - barHeight(bar, TEXT_SIZE);
    drawColourBar(pen, { x: MARGIN, y, width: Math.min(BAR_WIDTH, width - 2 * MARGIN), fontSize: TEXT_SIZE, ink, halo }, bar);
  }
}
