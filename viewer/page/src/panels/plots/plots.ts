/** Plots of pairs, contacts and stage times over frames. The cursor marks the current frame. */
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { plotSvg } from "../../capture/plot_svg";
import { linesOf, nounOf, plotsOf, type PlotForm } from "../../capture/plots";
import { EVENT_LABELS } from "../../history";
import type { Model } from "../../model";
import { EVENT_KINDS, type EventKind } from "../../protocol/messages";
import { colourOf, download, h, readable, remPixels, stamp } from "../dom";
import { axisLook, CURSOR, markStep, onClick } from "./plot_parts";

const HEIGHT = 132;
const REDRAW_MILLISECONDS = 150;

interface Plot {
  form: PlotForm;
  plot: uPlot;
}

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
    for (const form of plotsOf(this.model)) this.add(form);
    if (this.plots.length === 0) this.element.append(h("p", { class: "hint empty" }, "This recording has no time series."));
    this.element.append(h("figure", {}, h("figcaption", {}, "Collisions of two objects"), this.events));
    this.update();
  }

  private add(form: PlotForm): void {
    const { title, columns } = form;
    const lines = linesOf(this.model, form, colourOf("--ink"));
    const axis = axisLook();
    const save = h("button", { type: "button", class: "link", "aria-label": `Save ${title} as SVG`, onclick: () => this.save(form) }, "SVG");
    const holder = h("figure", { "aria-label": title }, h("figcaption", {}, title, " ", save));
    const options: uPlot.Options = {
      width: Math.max(120, this.element.clientWidth),
      height: HEIGHT,
      scales: { x: { time: false } },
      legend: { live: false },
      cursor: CURSOR,
      axes: [{ ...axis, size: 1.75 * remPixels() }, { ...axis, size: 3.5 * remPixels() }],
      series: [{ label: "frame" }, ...lines.map(({ label, colour }) => ({ label, stroke: colour, width: 1.5, points: { show: false } }))],
      hooks: { draw: [(plot) => markStep(plot, this.model.frame?.text.step)] },
    };
    const empty = [[], ...columns.map(() => [])] as unknown as uPlot.AlignedData;
    const plot = new uPlot(options, empty, holder);
    onClick(plot, (row) => this.seek(this.model.history.frames[row]!));
    this.element.append(holder);
    this.plots.push({ form, plot });
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
    for (const { form, plot } of this.plots) plot.setData([frames, ...linesOf(this.model, form).map(({ values }) => values)]);
  }

  /** On white, whatever the theme is. */
  private save(form: PlotForm): void {
    const svg = plotSvg(form.title, nounOf(this.model), this.model.history.frames, linesOf(this.model, form));
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
