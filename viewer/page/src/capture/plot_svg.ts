/** A plot of the page as SVG, from the same numbers. */
import { readable } from "../panels/dom";
import { niceStep, ticks } from "../view/world";
import { short, svgPen, type Text } from "./pen";

export interface PlotLine {
  label: string;
  colour: string;
  values: ArrayLike<number>;
}

/** In CSS pixels. */
const WIDTH = 480;
const HEIGHT = 240;
const [LEFT, RIGHT, TOP, BOTTOM] = [56, 12, 44, 36];
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

export function plotSvg(title: string, noun: string, frames: ArrayLike<number>, lines: PlotLine[]): string {
  const all = lines.flatMap(({ values }) => Array.from(values)).filter(Number.isFinite);
  const highest = all.reduce((most, value) => Math.max(most, value), 0) || 1;
  const lowest = all.reduce((least, value) => Math.min(least, value), 0);
  const [first, last] = [frames[0] ?? 0, Math.max(frames[frames.length - 1] ?? 1, (frames[0] ?? 0) + 1)];
  const x = (frame: number) => LEFT + ((frame - first) / (last - first)) * (WIDTH - LEFT - RIGHT);
  const y = (value: number) => HEIGHT - BOTTOM - ((value - lowest) / (highest - lowest)) * (HEIGHT - TOP - BOTTOM);
  const parts: string[] = [];
  const pen = svgPen(parts);
  const rule = (x1: number, y1: number, x2: number, y2: number) => parts.push(`<path d="M${short(x1)} ${short(y1)}L${short(x2)} ${short(y2)}" stroke="${GRID}"/>`);
  const words = (value: number) => readable(Number(value.toPrecision(6)));
  pen.box(0, 0, WIDTH, HEIGHT, "#ffffff", null);
  pen.text(LEFT, 16, title, { ...LABEL, size: 12 });
  for (const value of ticks(lowest, highest, niceStep(highest - lowest))) {
    rule(LEFT, y(value), WIDTH - RIGHT, y(value));
    pen.text(LEFT - 6, y(value) + 4, words(value), { ...LABEL, align: "end" });
  }
  for (const frame of ticks(first, last, Math.max(1, niceStep(last - first)))) {
    rule(x(frame), TOP, x(frame), HEIGHT - BOTTOM);
    pen.text(x(frame) + 3, HEIGHT - BOTTOM + 14, words(frame), { ...LABEL, align: "end" });
  }
  pen.text(WIDTH - RIGHT, HEIGHT - 6, noun, { ...LABEL, align: "end" });
  let at = LEFT;
  for (const { label, colour, values } of lines) {
    parts.push(`<path d="${pathOf(frames, values, x, y)}" stroke="${colour}" stroke-width="1.5" fill="none" stroke-linejoin="round"/>`);
    pen.box(at, 26, 10, 3, colour, null);
    pen.text(at + 14, 31, label, LABEL);
    at += 24 + LETTER * LABEL.size * label.length;
  }
  const width = Math.max(WIDTH, Math.ceil(at));
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${HEIGHT}" viewBox="0 0 ${width} ${HEIGHT}">\n${parts.join("\n")}\n</svg>\n`;
}
