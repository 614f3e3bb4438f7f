/** Asks which frames to save and at which size, then shows the progress. */
import { MOST_FILES } from "../capture/archive";
import type { FramesPlan } from "../capture/frames";
import type { Model } from "../model";
import type { PictureSize, SceneView } from "../view/scene_view";
import { h, readable, sheet } from "./dom";

const MOST_STEPS = 1_000_000;
const USUAL_COUNT = 300;
const USUAL_SIZES: PictureSize[] = [{ width: 1920, height: 1080 }, { width: 3840, height: 2160 }];

const words = ({ width, height }: PictureSize): string => `${width} × ${height}`;
/** Video encoders require even numbers. */
const even = (x: number): number => Math.max(2, 2 * Math.floor(x / 2));

type Save = (plan: FramesPlan, signal: AbortSignal, progress: (taken: number) => void) => Promise<string>;

export class FramesDialog {
  readonly element: HTMLDialogElement;
  private running: AbortController | null = null;
  private readonly size = h("select", { "aria-label": "Size", autofocus: true });
  private readonly width = this.number("Width", 2);
  private readonly height = this.number("Height", 2);
  private readonly count = this.number("Pictures", 1);
  private readonly until = this.number("Last frame", 0);
  private readonly every = this.number("Every n-th step", 1);
  private readonly transparent = h("input", { type: "checkbox" });
  private readonly summary = h("output", { class: "hint", "aria-label": "What will be saved" });
  private readonly form: HTMLFormElement;
  private readonly own = h("label", {}, h("span", {}, "Own size"), h("span", { class: "pair" }, this.width, "×", this.height));
  private readonly counted = h("label", {}, h("span", {}, "Pictures"), this.count);
  private readonly reached = h("label", {}, h("span", {}, "Up to frame"), this.until);
  private readonly bar = h("progress", { "aria-label": "Pictures taken" });
  private readonly place = h("output", { "aria-label": "Progress", "aria-live": "off" });
  private readonly cancel = h("button", { type: "button", class: "text-button", onclick: () => this.giveUp() }, "Cancel");
  private readonly work = h("div", { class: "work", hidden: true }, this.bar, this.place, this.cancel);

  constructor(private readonly model: Model, private readonly view: SceneView, private readonly save: Save, private readonly say: (text: string) => void) {
    this.form = h(
      "form", { onsubmit: (event: SubmitEvent) => this.submit(event), oninput: () => this.fit() },
      h("label", {}, h("span", {}, "Size"), this.size), this.own, this.counted, this.reached,
      h("label", {}, h("span", {}, "Every n-th step"), this.every),
      h("label", { class: "check" }, this.transparent, "Transparent ground"),
      this.summary,
      h("button", { type: "submit", class: "primary" }, "Save"),
    );
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
    for (const input of [this.width, this.height]) input.max = String(most);
    this.width.value ||= String(window[0]!.width);
    this.height.value ||= String(window[0]!.height);
  }

  private option(label: string, { width, height }: PictureSize, most: number): HTMLOptionElement {
    return h("option", { value: `${width} ${height}`, disabled: Math.max(width, height) > most }, label);
  }

  /** The chosen values; missing numbers are NaN. */
  private plan(): FramesPlan {
    const [width, height] = this.size.value.split(" ").map(Number);
    const size = height === undefined ? { width: this.width.valueAsNumber, height: this.height.valueAsNumber } : { width: width!, height };
    const every = this.every.valueAsNumber;
    const count = this.frames === null ? this.count.valueAsNumber : 1 + Math.floor((this.until.valueAsNumber - this.step) / every);
    return { count: Math.min(count, MOST_FILES), every, size, transparent: this.transparent.checked };
  }

  /** Shows the fields that match the choice, and a summary of it. */
  private fit(): void {
    this.until.min = String(this.step);
    this.own.hidden = this.width.disabled = this.height.disabled = this.size.value !== "";
    const { count, every, size } = this.plan();
    const isWhole = [count, every, size.width, size.height].every((x) => Number.isInteger(x) && x > 0);
    const noun = this.frames === null ? "step" : "frame";
    const last = readable(this.step + (count - 1) * every);
    const text = count === 1 ? `One picture, of ${noun} ${last}, as PNG` : `${readable(count)} pictures, of ${noun} ${readable(this.step)} to ${last}, in one ZIP`;
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
