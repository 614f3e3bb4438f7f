/** The user's own program: what it does, the events that pause it, and why it is paused. */
import type { Client } from "../client";
import { boundsOf } from "../bounds";
import type { Model } from "../model";
import type { Break, BreakSetting } from "../protocol/messages";
import { h, readable } from "./dom";

const ASK_MILLISECONDS = 1000;
/** A step that takes longer is said. */
const LONG_SECONDS = 2;

export class Program {
  readonly element = h("div", { class: "breaks", role: "group", "aria-label": "Pause the program", hidden: true });
  /** Above the view: why the program is paused, or that it does not reach the next step. */
  readonly banner = h("div", { class: "banner", role: "status", "aria-label": "Program", hidden: true });
  private readonly refusal = h("p", { class: "refusal", role: "alert", hidden: true });
  private readonly objects: HTMLSelectElement[];
  private inputs = new Map<string, HTMLInputElement>();
  private reason: Break | null = null;
  private shown = "";

  constructor(private readonly model: Model, private readonly client: Client, private readonly flyTo: (point: number[], reach: number) => void) {
    this.objects = ["First object", "Second object"].map((label) => h("select", { "aria-label": label, onchange: () => this.send() }));
    model.on("scene", () => this.build());
    model.on("frame", ({ text }) => this.showReason(text.break ?? null, text.step));
    client.on("status", () => this.say("", []));
    setInterval(() => void this.askForState(), ASK_MILLISECONDS);
  }

  private get isProgram(): boolean {
    return this.model.scene?.source === "program";
  }

  private build(): void {
    this.element.hidden = !this.isProgram;
    if (!this.isProgram) return;
    const { breaks, break_objects: names } = this.model.scene!;
    this.inputs.clear();
    this.element.replaceChildren(
      h("h3", {}, "Pause the program when"), ...breaks!.flatMap((setting) => this.row(setting)), this.refusal,
    );
    const every = [...new Set(this.model.objects.map(({ name }) => name).filter((name) => name !== ""))];
    this.objects.forEach((select, i) => {
      select.replaceChildren(h("option", { value: "" }, "any object"), ...every.map((name) => h("option", { value: name }, name)));
      select.value = names![i]!;
    });
  }

  private row({ key, doc, unit, kind, value }: BreakSetting): HTMLElement[] {
    const id = `break-${key}`;
    const isNumber = kind === "number";
    const input = h("input", isNumber ? { type: "text", inputmode: "decimal", id, placeholder: "never", onchange: () => this.send() } : { type: "checkbox", id, onchange: () => this.send() });
    if (isNumber) input.value = value === null ? "" : String(value);
    else input.checked = value === true;
    this.inputs.set(key, input);
    const label = h("label", { for: id }, doc);
    if (unit) input.title = unit;
    const row = h("div", { class: "break-row" }, ...(isNumber ? [label, input] : [input, label]));
    if (key !== "contact_begin") return [row];
    return [row, h("div", { class: "break-row break-pair" }, this.objects[0]!, "and", this.objects[1]!)];
  }

  private send(): void {
    const breaks: Record<string, unknown> = { objects: this.objects.map((select) => select.value) };
    for (const [key, input] of this.inputs) {
      const text = input.value.trim();
      if (input.type === "checkbox") breaks[key] = input.checked;
      else breaks[key] = text === "" ? null : Number.isFinite(Number(text)) ? Number(text) : text;
    }
    this.client.ask({ do: "break", ...breaks }).then(() => this.refuse(""), (error: Error) => this.refuse(error.message));
  }

  private refuse(text: string): void {
    this.refusal.hidden = text === "";
    const key = /^break: (\w+)/.exec(text)?.[1];
    const label = this.model.scene!.breaks?.find((setting) => setting.key === key)?.doc ?? key;
    this.refusal.textContent = text.replace(/^break: \w+/, `“${label}”`);
  }

  private showReason(reason: Break | null, step: number): void {
    const isNew = reason !== null && (reason.text !== this.reason?.text || this.banner.hidden);
    const before = this.reason;
    this.reason = reason;
    // A late frame does not tell whether the program goes on.
    if (!reason) return before ? this.say("", []) : undefined;
    const { point, objects } = reason;
    const show = () => {
      if (point) this.flyTo(point, this.reachOf(objects));
      else if (objects.length > 0) this.model.select({ object: objects[0]!, triangle: null, vertex: null });
    };
    const buttons = this.client.watches ? [] : [h("button", { type: "button", class: "primary", onclick: () => this.client.send({ do: "play" }) }, "Continue")];
    if (point || objects.length > 0) buttons.unshift(h("button", { type: "button", class: "text-button", onclick: show }, "Show"));
    this.say(`Paused in step ${readable(step)}: ${reason.text}`, buttons);
    if (isNew) show();
  }

  /** Shows the smaller object whole, so that one sees where the point is. */
  private reachOf(objects: number[]): number {
    const sizes = objects.map((object) => boundsOf(this.model.objects[object]!)).map((bounds) => (bounds ? Math.hypot(...bounds.upper.map((x, axis) => x - bounds.lower[axis]!)) / 2 : 0));
    const reach = Math.min(...sizes.filter((size) => size > 0));
    return Number.isFinite(reach) ? reach : 0;
  }

  /** The program runs on its own: only an answer tells whether it still does. */
  private async askForState(): Promise<void> {
    if (!this.isProgram || this.client.status.state !== "connected" || this.reason) return;
    const state = await this.client.ask({ do: "program" }).catch(() => null);
    if (!state || this.reason) return;
    const seconds = state["seconds_since_step"] as number;
    const isLong = seconds > LONG_SECONDS;
    this.say(isLong ? `The last step, ${readable(state["step"] as number)}, ended ${Math.round(seconds)} s ago. The program works on the next one.` : "", []);
  }

  private say(text: string, buttons: HTMLElement[]): void {
    if (text === this.shown) return;
    this.shown = text;
    this.banner.hidden = text === "";
    this.banner.replaceChildren(h("span", {}, text), ...buttons);
  }
}
