/** Plots of the values of one pin over its steps. The cursor marks the current step; a click goes to a step. */
import uPlot from "uplot";
import { OKABE_ITO } from "../../colours";
import type { Model } from "../../model";
import type { Pin } from "../../pins";
import { h, readable, remPixels } from "../dom";
import { axisLook, CURSOR, markStep, onClick } from "./plot_parts";

const HEIGHT = 92;
const LINES = [OKABE_ITO.blue, OKABE_ITO.vermillion, OKABE_ITO.green];

interface Plot {
  columns: number[];
  caption: HTMLElement;
  plot: uPlot;
}

/** `normal_x`, `normal_y` and `normal_z` are in one plot. */
const familyOf = (name: string): string => name.replace(/_[xyz]$/, "");
const hasData = (column: number[]): boolean => column.some((value) => !Number.isNaN(value));

export class PinPlots {
  readonly element = h("div", { class: "plots" });
  private plots: Plot[] = [];
  private built = "";
  private pin: Pin | null = null;
  private names: string[] = [];

  constructor(private readonly model: Model, private readonly seek: (step: number) => void) {
    new ResizeObserver(() => requestAnimationFrame(() => this.resize())).observe(this.element);
  }

  rebuild(): void {
    this.built = "";
    if (this.pin) this.show(this.pin, this.names);
  }

  /** Plots the values that have numbers. */
  show(pin: Pin, names: string[]): void {
    this.pin = pin;
    this.names = names;
    if (this.element.clientWidth === 0) return;  // another tab is visible
    const families = [...new Set(names.filter((_, i) => hasData(pin.series.columns[i]!)).map(familyOf))];
    const wanted = `${pin.number} ${families.join()}`;
    if (wanted !== this.built) this.build(families);
    this.built = wanted;
    this.update();
  }

  private build(families: string[]): void {
    for (const { plot } of this.plots) plot.destroy();
    this.plots = [];
    this.element.replaceChildren();
    for (const family of families) this.add(family);
  }

  private add(family: string): void {
    const columns = this.names.flatMap((name, i) => (familyOf(name) === family ? [i] : []));
    const { doc, unit } = this.model.scene!.pin_values[columns[0]!]!;
    const caption = h("figcaption", { title: unit ? `${doc} (${unit})` : doc });
    const holder = h("figure", { "aria-label": family.replace(/_/g, " ") }, caption);
    const axis = axisLook();
    const plot = new uPlot({
      width: Math.max(120, this.element.clientWidth), height: HEIGHT, scales: { x: { time: false }, ...(family === "normal" && { y: { range: [-1, 1] } }) }, legend: { show: false },
      cursor: CURSOR,
      axes: [{ ...axis, size: 1.75 * remPixels() }, { ...axis, size: 3.5 * remPixels(), space: 1.25 * remPixels() }],
      series: [{ label: "step" }, ...columns.map((column, i) => ({ label: this.names[column]!, stroke: LINES[i]!, width: 1.5, points: { show: (self: uPlot) => self.data[0].length < 3 } }))],
      hooks: { draw: [(self) => markStep(self, this.model.frame?.text.step)] },
    }, [[], ...columns.map(() => [])] as unknown as uPlot.AlignedData, holder);
    onClick(plot, (row) => this.seek(this.pin!.series.steps[row]!));
    this.element.append(holder);
    this.plots.push({ columns, caption, plot });
  }

  private update(): void {
    const { series } = this.pin!;
    const step = this.model.frame?.text.step ?? -1;
    for (const { columns, caption, plot } of this.plots) {
      const gaps = (column: number[]) => column.map((value) => (Number.isNaN(value) ? null : value));
      plot.setData([series.steps, ...columns.map((column) => gaps(series.columns[column]!))]);
      const values = columns.map((column) => series.at(column, step));
      const now = values.some(Number.isNaN) ? "–" : values.map((value) => readable(Number(value.toPrecision(4)))).join(", ");
      const text = `${familyOf(this.names[columns[0]!]!).replace(/_/g, " ")}: ${now}`;
      if (caption.textContent !== text) caption.textContent = text;
    }
  }

  private resize(): void {
    const width = this.element.clientWidth;
    if (width === 0 || !this.pin) return;
    for (const { plot } of this.plots) if (plot.width !== width) plot.setSize({ width, height: HEIGHT });
    this.show(this.pin, this.names);
  }
}
