/** A plot of the page as SVG, from the same numbers. */
import { readable } from "../panels/dom";
import { niceStep, ticks } from "../view/world";
import { short, svgFile, svgPen, type Sheet, type Text } from "./pen";

export interface PlotLine {
  label: string;
  colour: string;
  values: number[];
}

/** Sizes in CSS pixels. */
const USUAL: Sheet = { width: 480, height: 240, millimetres: null };
const [LEFT, RIGHT, TOP, BOTTOM] = [56, 12, 44, 36];
const ROW = 16;
const INK = "#1b2027";
const GRID = "#dde0e5";
const LABEL: Text = { size: 11, colour: INK, halo: null, align: "start" };
/** The width of a letter of a label is at most this part of its size. */
const LETTER = 0.62;

/** The pieces of a line between values that are not finite. */
function pathOf(frames: ArrayLike<number>, values: ArrayLike<number>, x: (frame: number) => number, y: (value: number) => number): string {
  let path = "";
  for (let i = 0, isOn = false; i < frames.length; ++i) {
    const isFinite = Number.isFinite(values[i]);
    if (isFinite) path += `${isOn ? "L" : "M"}${short(x(frames[i]!))} ${short(y(values[i]!))}`;
    isOn = isFinite;
  }
  return path;
}

/** Where each label begins: beside the one before, or in the next row. */
function placesOf(labels: string[], width: number): { x: number; row: number }[] {
  let [x, row] = [LEFT, 0];
  return labels.map((label) => {
    const needed = 14 + LETTER * LABEL.size * label.length;
    if (x > LEFT && x + needed > width - RIGHT) [x, row] = [LEFT, row + 1];
    const place = { x, row };
    x += needed + 10;
    return place;
  });
}

export function plotSvg(title: string, noun: string, frames: ArrayLike<number>, lines: PlotLine[], sheet = USUAL): string {
  const { width, height } = sheet;
  const places = placesOf(lines.map(({ label }) => label), width);
  const top = TOP + ROW * (places.at(-1)?.row ?? 0);
  const all = lines.flatMap(({ values }) => Array.from(values)).filter(Number.isFinite);
  const highest = all.reduce((most, value) => Math.max(most, value), 0) || 1;
  const lowest = all.reduce((least, value) => Math.min(least, value), 0);
  const [first, last] = [frames[0] ?? 0, Math.max(frames[frames.length - 1] ?? 1, (frames[0] ?? 0) + 1)];
  const x = (frame: number) => LEFT + ((frame - first) / (last - first)) * (width - LEFT - RIGHT);
  const y = (value: number) => height - BOTTOM - ((value - lowest) / (highest - lowest)) * (height - top - BOTTOM);
  const parts: string[] = [];
  const pen = svgPen(parts);
  const rule = (x1: number, y1: number, x2: number, y2: number) => parts.push(`<path d="M${short(x1)} ${short(y1)}L${short(x2)} ${short(y2)}" stroke="${GRID}"/>`);
  const words = (value: number) => readable(Number(value.toPrecision(6)));
  pen.box(0, 0, width, height, "#ffffff", null);
  pen.text(LEFT, 16, title, { ...LABEL, size: 12 });
  for (const value of ticks(lowest, highest, niceStep(highest - lowest))) {
    rule(LEFT, y(value), width - RIGHT, y(value));
    pen.text(LEFT - 6, y(value) + 4, words(value), { ...LABEL, align: "end" });
  }
  for (const frame of ticks(first, last, Math.max(1, niceStep(last - first)))) {
    rule(x(frame), top, x(frame), height - BOTTOM);
    pen.text(x(frame) + 3, height - BOTTOM + 14, words(frame), { ...LABEL, align: "end" });
  }
  pen.text(width - RIGHT, height - 6, noun, { ...LABEL, align: "end" });
  lines.forEach(({ label, colour, values }, i) => {
    const { x: at, row } = places[i]!;
    parts.push(`<path d="${pathOf(frames, values, x, y)}" stroke="${colour}" stroke-width="1.5" fill="none" stroke-linejoin="round"/>`);
    pen.box(at, 26 + ROW * row, 10, 3, colour, null);
    pen.text(at + 14, 31 + ROW * row, label, LABEL);
  });
  return svgFile(sheet, parts);
}
