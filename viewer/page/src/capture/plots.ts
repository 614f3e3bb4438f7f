/** The plots of a run: which there are, with their curves. The panel draws them, and `supple render --plot` saves them. */
import type { Client } from "../client";
import { OKABE_ITO } from "../colours";
import type { Model } from "../model";
import { titleOf, type Pins } from "../pins";
import { formOf } from "../protocol/lists";
import { ANSWERS, hasColumn } from "../records";
import { CSS_DPI } from "./figure";
import { goTo } from "./frames";
import { millimetresOf } from "./pen";
import { encode } from "./picture";
import { plotSvg, type PlotLine } from "./plot_svg";
import { withResolution } from "./png";

export interface PlotForm {
  /** As `--plot` says it. */
  name: string;
  title: string;
  columns: string[];
  /** The values are those of the columns times this. */
  scale: number;
}

const LINES = [OKABE_ITO.blue, OKABE_ITO.orange, OKABE_ITO.green, OKABE_ITO.vermillion, OKABE_ITO.purple, OKABE_ITO.sky, "#8a8f98", "#9c6b3c", "#5b4bb5"];
const lineColour = (i: number): string => LINES[i % LINES.length]!;

/** Columns of the second of two recordings end with `_b`. */
const labelOf = (name: string): string => name.replace(/_b$/, " of B").replace(/_seconds$/, "").replace(/_/g, " ");

/** The plots that the series of this run allow. */
export function plotsOf({ scene, history: { names } }: Model): PlotForm[] {
  const has = (wanted: string[]) => wanted.flatMap((name) => [name, `${name}_b`]).filter((name) => names.includes(name));
  const near = ANSWERS.filter((list) => hasColumn(list, "distance") && scene!.contacts.includes(formOf(list).answers));
  return [
    { name: "pairs", title: "Object pairs", columns: has(["object_pairs"]), scale: 1 },
    { name: "contacts", title: "Contacts and candidates", columns: has(["contacts", "candidate_pairs", ...near]), scale: 1 },
    { name: "times", title: "Time per stage, milliseconds", columns: names.filter((name) => name.endsWith("_seconds")), scale: 1000 },
  ].filter(({ columns }) => columns.length > 0);
}

/** `ink` is the colour of the total of all stages. */
export function linesOf({ history }: Model, { columns, scale }: PlotForm, ink = "#1b2027"): PlotLine[] {
  return columns.map((name, i) => {
    const isTotal = name === "total_seconds";
    const column = history.column(name)!;
    // The total of the library is that of the detection; the plot also has the time of the motion.
    const motion = isTotal ? history.column("motion_seconds") : null;
    const values = scale === 1 ? column : column.map((value, at) => (value + (motion?.[at] ?? 0)) * scale);
    return { label: labelOf(name), colour: isTotal ? ink : lineColour(i), values };
  });
}

/** The steps are those of a recording's frames, or of a simulation. */
export const nounOf = ({ scene }: Model): string => (scene!.frames === null ? "step" : "frame");

interface Curves {
  title: string;
  frames: number[];
  lines: PlotLine[];
}

/** One value of all pins; the components of a vector are values of their own. */
function curvesOfPins(model: Model, pins: Pins, value: string): Curves {
  const forms = model.scene!.pin_values;
  const columns = forms.flatMap(({ key }, i) => (key.replace(/_[xyz]$/, "") === value ? [i] : []));
  const frames = [...new Set(pins.list.flatMap(({ series }) => series.steps))].sort((a, b) => a - b);
  const curves = pins.list.flatMap((pin) => columns.map((column) => {
    const part = columns.length > 1 ? ` ${forms[column]!.key.at(-1)}` : "";
    return { label: titleOf(pin) + part, values: frames.map((frame) => pin.series.at(column, frame)) };
  }));
  const { doc, unit } = forms[columns[0]!]!;
  const title = doc.replace(/: x$/, "") + (unit ? ` (${unit})` : "");
  return { title, frames, lines: curves.map((curve, i) => ({ ...curve, colour: lineColour(i) })) };
}

const PIN = "pin-";

function curvesOf(model: Model, pins: Pins, name: string): Curves {
  if (name.startsWith(PIN)) return curvesOfPins(model, pins, name.slice(PIN.length));
  const form = plotsOf(model).find((plot) => plot.name === name);
  if (!form) throw new Error(`This recording has no numbers for the plot ${name}.`);
  return { title: form.title, frames: model.history.frames, lines: linesOf(model, form) };
}

export interface PlotPlan {
  name: string;
  /** First, last, every n-th; null for all frames of a recording. */
  frames: [number, number, number] | null;
  /** In pixels. */
  size: { width: number; height: number };
  dpi: number;
  format: "png" | "svg";
}

async function drawn(svg: Blob, { size: { width, height }, dpi }: PlotPlan): Promise<Blob> {
  const image = new Image();
  image.src = URL.createObjectURL(svg);
  await image.decode();
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  canvas.getContext("2d")!.drawImage(image, 0, 0, width, height);
  return withResolution(await encode(canvas), dpi);
}

/**
 * Runs through the frames of a plan and draws their plot. `progress` gets each frame. When the session fails on the
 * way, the plot ends there, and `failure` says why. Throws a sentence when there is nothing to draw.
 */
export async function takePlot(model: Model, client: Client, pins: Pins, plan: PlotPlan, progress: (step: number) => Promise<void>): Promise<{ plot: Blob; failure: string | null }> {
  const { name, size: { width, height }, dpi, format } = plan;
  const isOfPins = name.startsWith(PIN);
  if (isOfPins && pins.list.length === 0) throw new Error("The view file has no pin of an object of this scene.");
  const count = model.scene!.frames;
  const [first, last, every] = plan.frames ?? [0, (count ?? 1) - 1, 1];
  model.history.most = pins.mostRows = Infinity;
  const { signal } = new AbortController();
  await client.ask({ do: "pause" });
  let at = await client.frameThat((frame) => !frame.playing, signal);
  let failure: string | null = null;
  // The numbers of a recording come with its scene; the values of pins come with each frame.
  if (count === null || isOfPins)
    try {
      for (let frame = first; frame <= last; frame += every) {
        if (at.step !== frame) at = await goTo(model, client, frame, signal);
        await progress(frame);
      }
    } catch (error) {
      if (at.step <= first) throw error;
      failure = `${(error as Error).message.replace(/\.$/, "")}; the plot ends at ${nounOf(model)} ${at.step}`;
    }
  const { title, frames, lines } = curvesOf(model, pins, name);
  const kept = frames.flatMap((frame, i) => (frame >= first && frame <= last && (frame - first) % every === 0 ? [i] : []));
  const shown = lines.map((line) => ({ ...line, values: kept.map((i) => line.values[i]!) })).filter(({ values }) => values.some(Number.isFinite));
  if (shown.length === 0) throw new Error(`No frame has a number for the plot ${name}.`);
  const scale = CSS_DPI / dpi;
  const svg = plotSvg(title, nounOf(model), kept.map((i) => frames[i]!), shown, { width: width * scale, height: height * scale, millimetres: millimetresOf(width, dpi) });
  const file = new Blob([svg], { type: "image/svg+xml" });
  return { plot: format === "svg" ? file : await drawn(file, plan), failure };
}
