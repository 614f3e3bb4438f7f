/** Asks which frames to save, at which size and with what around them, then shows the progress. */
import { MOST_FILES } from "../capture/archive";
import type { Figure } from "../capture/figure";
import type { FramesPlan } from "../capture/frames";
import { readField } from "../fields/fields";
import type { Model } from "../model";
import type { Background, PictureSize, SceneView } from "../view/scene_view";
import { h, readable, sheet } from "./dom";

const MOST_STEPS = 1_000_000;
const USUAL_COUNT = 300;
const USUAL_DPI = 300;
const MILLIMETRES_PER_INCH = 25.4;
const BACKGROUNDS: Record<Background, string> = { theme: "As in the window", white: "White", transparent: "Transparent" };
const FORMATS: Record<Figure["format"], string> = { png: "PNG", svg: "SVG of lines" };
const USUAL_SIZES: PictureSize[] = [{ width: 1920, height: 1080 }, { width: 3840, height: 2160 }];

const words = ({ width, height }: PictureSize): string => `${width} × ${height}`;
/** Video encoders require even numbers. */
const even = (x: number): number => Math.max(2, 2 * Math.floor(x / 2));

type Save = (plan: FramesPlan, signal: AbortSignal, progress: (taken: number) => void) => Promise<string>;

export class FramesDialog {
  readonly element: HTMLDialogElement;
  private running: AbortController | null = null;
  private readonly size = h("select", { "aria-label": "Size", autofocus: true });
  private readonly width = this.number("Width", 1);
  private readonly height = this.number("Height", 1);
  private readonly unit = h("select", { "aria-label": "Unit" }, h("option", { value: "pixels" }, "px"), h("option", { value: "millimetres" }, "mm"));
  private readonly dpi = h("input", { type: "number", "aria-label": "Pixels per inch", min: 10, max: 2400, step: "any", placeholder: "as in the window" });
  private readonly format = this.choice("Format", FORMATS);
  private readonly background = this.choice("Background", BACKGROUNDS);
  private readonly legend = h("input", { type: "checkbox" });
  private readonly scaleBar = h("input", { type: "checkbox" });
  private readonly colourBar = h("input", { type: "checkbox" });
  private readonly ofField = h("label", { class: "check" }, this.colourBar, "Colour bar of the field");
  private readonly count = this.number("Pictures", 1);
  private readonly until = this.number("Last frame", 0);
  private readonly every = this.number("Every n-th step", 1);
  private readonly summary = h("output", { class: "hint", "aria-label": "What will be saved" });
  private readonly form: HTMLFormElement;
  private readonly own = h("label", {}, h("span", {}, "Own size"), h("span", { class: "pair" }, this.width, "×", this.height, this.unit));
  private readonly hint = h("p", { class: "hint", hidden: true }, "Outlines, wireframes, contact segments and points as vectors. Surfaces hide what is behind them, to a pixel.");
  private readonly counted = h("label", {}, h("span", {}, "Pictures"), this.count);
  private readonly reached = h("label", {}, h("span", {}, "Up to frame"), this.until);
  private readonly bar = h("progress", { "aria-label": "Pictures taken" });
  private readonly place = h("output", { "aria-label": "Progress", "aria-live": "off" });
  private readonly cancel = h("button", { type: "button", class: "text-button", onclick: () => this.giveUp() }, "Cancel");
  private readonly work = h("div", { class: "work", hidden: true }, this.bar, this.place, this.cancel);

  constructor(private readonly model: Model, private readonly view: SceneView, private readonly save: Save, private readonly say: (text: string) => void) {
    this.form = h(
      "form", { onsubmit: (event: SubmitEvent) => this.submit(event), oninput: () => this.fit() },
      this.row("Format", this.format), this.hint, this.row("Size", this.size), this.own,
      h("label", { title: "The file says it, and texts and marks have their size in print" }, h("span", {}, "Pixels per inch"), this.dpi),
      this.counted, this.reached, this.row("Every n-th step", this.every), this.row("Background", this.background),
      h("label", { class: "check" }, this.legend, "Legend with the names of objects"),
      h("label", { class: "check" }, this.scaleBar, "Scale bar"),
      this.ofField,
      this.summary,
      h("button", { type: "submit", class: "primary" }, "Save"),
    );
    this.unit.addEventListener("change", () => this.convert());
    this.element = sheet("Save frames as pictures", "frames", this.form, this.work);
    this.element.addEventListener("cancel", (event) => {
      if (!this.running) return;
      event.preventDefault();
      this.giveUp();
    });
    this.element.addEventListener("close", () => this.giveUp());
    model.on("frame", () => this.element.open && !this.running && this.fit());
  }

  private number(label: string, min: number): HTMLInputElement {
    return h("input", { type: "number", "aria-label": label, min, step: 1, required: true });
  }

  private choice(label: string, words: Record<string, string>): HTMLSelectElement {
    return h("select", { "aria-label": label }, ...Object.entries(words).map(([value, text]) => h("option", { value }, text)));
  }

  private row(label: string, input: HTMLElement): HTMLElement {
    return h("label", {}, h("span", {}, label), input);
  }

  private get frames(): number | null {
    return this.model.scene?.frames ?? null;
  }

  private get step(): number {
    return this.model.frame?.text.step ?? 0;
  }

  /** Call when there is a frame. */
  open(): void {
    const { frames } = this;
    this.offerSizes();
    this.counted.hidden = this.count.disabled = frames !== null;
    this.reached.hidden = this.until.disabled = frames === null;
    this.count.max = String(MOST_FILES);
    const moves = this.model.scene!.objects.some((object) => object.body || object.waves || object.rigid);
    this.count.value ||= String(moves ? USUAL_COUNT : 1);
    this.every.max = String(MOST_STEPS);
    this.every.value ||= "1";
    if (frames !== null) this.until.max = this.until.value = String(frames - 1);
    this.fit();
    this.element.showModal();
  }

  private offerSizes(): void {
    const chosen = this.size.selectedIndex;
    const most = this.view.largestSide;
    const { width, height } = this.view.windowSize;
    const window = [1, 2].map((times) => ({ width: even(times * width), height: even(times * height) }));
    const labels = ["As in the window", "Twice the window"];
    this.size.replaceChildren(
      ...window.map((size, i) => this.option(`${labels[i]!} (${words(size)})`, size, most)),
      ...USUAL_SIZES.map((size) => this.option(words(size), size, most)),
      h("option", { value: "" }, "Own size"),
    );
    this.size.selectedIndex = Math.max(0, chosen);
    this.width.value ||= String(window[0]!.width);
    this.height.value ||= String(window[0]!.height);
  }

  private option(label: string, { width, height }: PictureSize, most: number): HTMLOptionElement {
    return h("option", { value: `${width} ${height}`, disabled: Math.max(width, height) > most }, label);
  }

  /** Keeps the size when its unit changes. */
  private convert(): void {
    this.dpi.value ||= String(USUAL_DPI);
    const pixels = this.dpi.valueAsNumber / MILLIMETRES_PER_INCH;
    for (const input of [this.width, this.height])
      input.value = String(this.unit.value === "millimetres" ? Math.round((10 * input.valueAsNumber) / pixels) / 10 : Math.round(input.valueAsNumber * pixels));
    this.fit();
  }

  /** In pixels; missing numbers are NaN. */
  private chosenSize(dpi: number | null): PictureSize {
    const [width, height] = this.size.value.split(" ").map(Number);
    if (height !== undefined) return { width: width!, height };
    const scale = this.unit.value === "millimetres" ? dpi! / MILLIMETRES_PER_INCH : 1;
    return { width: Math.round(scale * this.width.valueAsNumber), height: Math.round(scale * this.height.valueAsNumber) };
  }

  /** The chosen values; missing numbers are NaN. */
  private plan(): FramesPlan {
    const dpi = Number.isNaN(this.dpi.valueAsNumber) ? null : this.dpi.valueAsNumber;
    const every = this.every.valueAsNumber;
    const count = this.frames === null ? this.count.valueAsNumber : 1 + Math.floor((this.until.valueAsNumber - this.step) / every);
    const figure = {
      size: this.chosenSize(dpi), dpi, format: this.format.value as Figure["format"], background: this.background.value as Background,
      legend: this.legend.checked, scaleBar: this.scaleBar.checked,
      colourBar: this.colourBar.checked && !this.ofField.hidden,
    };
    return { first: null, count: Math.min(count, MOST_FILES), every, figure };
  }

  /** Shows the fields that match the choice, and a summary of it. */
  private fit(): void {
    this.until.min = String(this.step);
    this.ofField.hidden = readField(this.model) === null;
    this.own.hidden = this.width.disabled = this.height.disabled = this.size.value !== "";
    const isInMillimetres = this.size.value === "" && this.unit.value === "millimetres";
    this.dpi.required = isInMillimetres;  // millimetres need it
    this.hint.hidden = this.format.value !== "svg";
    for (const input of [this.width, this.height]) {
      input.max = isInMillimetres ? "" : String(this.view.largestSide);
      input.step = isInMillimetres ? "any" : "1";
    }
    const { count, every, figure: { size, format } } = this.plan();
    const isTooLarge = isInMillimetres && Math.max(size.width, size.height) > this.view.largestSide;
    this.width.setCustomValidity(isTooLarge ? `This browser draws at most ${readable(this.view.largestSide)} pixels a side: ${words(size)} are too many. Choose a smaller size, or fewer pixels per inch.` : "");
    const isWhole = [count, every, size.width, size.height].every((x) => Number.isInteger(x) && x > 0);
    const noun = this.frames === null ? "step" : "frame";
    const last = readable(this.step + (count - 1) * every);
    const text = count === 1 ? `One picture, of ${noun} ${last}, as ${format.toUpperCase()}` : `${readable(count)} pictures, of ${noun} ${readable(this.step)} to ${last}, in one ZIP`;
    this.summary.textContent = isWhole ? `${text}; ${words(size)} pixels.` : "";
  }

  private submit(event: SubmitEvent): void {
    event.preventDefault();
    const plan = this.plan();
    this.running = new AbortController();
    this.show(0, plan.count);
    void this.save(plan, this.running.signal, (taken) => this.show(taken, plan.count)).then((sentence) => {
      this.running = null;
      this.form.hidden = false;
      this.work.hidden = true;
      this.element.close();
      this.say(sentence);
    });
    this.form.hidden = true;
    this.work.hidden = false;
    this.cancel.focus();
  }

  private show(taken: number, count: number): void {
    this.bar.max = count;
    this.bar.value = taken;
    this.place.textContent = `${readable(taken)} of ${readable(count)}`;
  }

  /** Stops. Pictures taken so far are still saved. */
  private giveUp(): void {
    this.running?.abort(new Error("Cancelled."));
  }
}
