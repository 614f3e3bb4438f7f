/** Plots of pairs, contacts and stage times over frames. The cursor marks the current frame. */
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { plotSvg } from "../../capture/plot_svg";
import { OKABE_ITO } from "../../colours";
import { EVENT_LABELS } from "../../history";
import type { Model } from "../../model";
import { EVENT_KINDS, type EventKind } from "../../protocol/messages";
import { colourOf, download, h, readable, remPixels, stamp } from "../dom";
import { axisLook, CURSOR, markStep, onClick } from "./plot_parts";

const HEIGHT = 132;
const REDRAW_MILLISECONDS = 150;
const LINES = [OKABE_ITO.blue, OKABE_ITO.orange, OKABE_ITO.green, OKABE_ITO.vermillion, OKABE_ITO.purple, OKABE_ITO.sky, "#8a8f98", "#9c6b3c"];

interface Plot {
  title: string;
  columns: string[];
  scale: number;
  plot: uPlot;
}

const isStage = (name: string): boolean => name.endsWith("_seconds");
/** Columns of the second of two recordings end with `_b`. */
const labelOf = (name: string): string => name.replace(/_b$/, " of B").replace(/_seconds$/, "").replace(/_/g, " ");

export class Plots {
  readonly element = h("div", { class: "plots" });
  private plots: Plot[] = [];
  /** How many pairs of objects began and ended, as the paper counts collisions. */
  private readonly events = h("dl", { "aria-label": "Events", title: "Collisions of the narrow phase are counted while the layer Colliding vertices is on, or in a recording made with --colliding-vertices" });
  private due: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly model: Model, private readonly seek: (frame: number) => void) {
    model.on("scene", () => this.build());
    model.on("history", () => this.later());
    model.on("frame", () => this.later());
    new ResizeObserver(() => requestAnimationFrame(() => this.resize())).observe(this.element);
  }

  /** Creates the plots again with the colours of the theme. */
  rebuild(): void {
    this.build();
  }

  private build(): void {
    for (const { plot } of this.plots) plot.destroy();
    this.plots = [];
    this.element.replaceChildren();
    if (!this.model.scene) return;
    const { names } = this.model.history;
    const has = (wanted: string[]) => wanted.flatMap((name) => [name, `${name}_b`]).filter((name) => names.includes(name));
    const stages = names.filter(isStage);
    this.add("Object pairs", has(["object_pairs"]), 1);
    const near = this.model.scene.contacts.includes("proximity") ? ["proximity_pairs"] : [];
    this.add("Contacts and candidates", has(["contacts", "candidate_pairs", ...near]), 1);
    this.add("Time per stage, milliseconds", stages, 1000);
    if (this.plots.length === 0) this.element.append(h("p", { class: "hint empty" }, "This recording has no time series."));
    this.element.append(h("figure", {}, h("figcaption", {}, "Collisions of two objects"), this.events));
    this.update();
  }

  private add(title: string, columns: string[], scale: number): void {
    if (columns.length === 0) return;
    const stroke = (name: string, i: number) => (name === "total_seconds" ? colourOf("--ink") : LINES[i % LINES.length]!);
    const axis = axisLook();
    const save = h("button", { type: "button", class: "link", "aria-label": `Save ${title} as SVG`, onclick: () => this.save(title, columns, scale) }, "SVG");
    const holder = h("figure", { "aria-label": title }, h("figcaption", {}, title, " ", save));
    const options: uPlot.Options = {
      width: Math.max(120, this.element.clientWidth),
      height: HEIGHT,
      scales: { x: { time: false } },
      legend: { live: false },
      cursor: CURSOR,
      axes: [{ ...axis, size: 1.75 * remPixels() }, { ...axis, size: 3.5 * remPixels() }],
      series: [{ label: "frame" }, ...columns.map((name, i) => ({ label: labelOf(name), stroke: stroke(name, i), width: 1.5, points: { show: false } }))],
      hooks: { draw: [(plot) => markStep(plot, this.model.frame?.text.step)] },
    };
    const empty = [[], ...columns.map(() => [])] as unknown as uPlot.AlignedData;
    const plot = new uPlot(options, empty, holder);
    onClick(plot, (row) => this.seek(this.model.history.frames[row]!));
    this.element.append(holder);
    this.plots.push({ title, columns, scale, plot });
  }

  private later(): void {
    this.due ??= setTimeout(() => {
      this.due = undefined;
      this.update();
    }, REDRAW_MILLISECONDS);
  }

  update(): void {
    if (this.element.clientWidth === 0) return;  // another tab is visible
    const { frames } = this.model.history;
    this.events.replaceChildren(
      ...EVENT_KINDS.flatMap((kind) => [h("dt", {}, EVENT_LABELS[kind]), h("dd", {}, this.countsOf(kind))]),
    );
    for (const { columns, scale, plot } of this.plots) {
      plot.setData([frames, ...columns.map((name) => this.values(name, scale))]);
    }
  }

  private values(name: string, scale: number): number[] {
    const column = this.model.history.column(name)!;
    // The total of the library is that of the detection; the plot also has the time of the motion.
    const motion = name === "total_seconds" ? this.model.history.column("motion_seconds") : null;
    return scale === 1 ? column : column.map((value, i) => (value + (motion?.[i] ?? 0)) * scale);
  }

  /** On white, whatever the theme is. */
  private save(title: string, columns: string[], scale: number): void {
    const lines = columns.map((name, i) => ({ label: labelOf(name), colour: name === "total_seconds" ? "#1b2027" : LINES[i % LINES.length]!, values: this.values(name, scale) }));
    const svg = plotSvg(title, this.model.scene!.frames === null ? "step" : "frame", this.model.history.frames, lines);
    download(new Blob([svg], { type: "image/svg+xml" }), `supple-plot-${stamp()}.svg`);
  }

  private countsOf(kind: EventKind): string {
    const { begin, end } = this.model.history.events[kind];
    if (kind === "narrow_phase" && begin.length === 0 && !this.model.layers.vertices)
      return "counted with Colliding vertices";
    return `${readable(begin.length)} began, ${readable(end.length)} ended`;
  }

  private resize(): void {
    const width = this.element.clientWidth;
    if (width === 0) return;
    for (const { plot } of this.plots) if (plot.width !== width) plot.setSize({ width, height: HEIGHT });
    this.update();
  }
}
