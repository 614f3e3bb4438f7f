/** A field for one option of the session. Its words, unit and help come from the description of the option. */
import type { Setting } from "../protocol/messages";
import { h, readable } from "./dom";

export type Value = string | number | boolean;

/** `broad_phase` becomes `Broad phase`. */
export const labelOf = (key: string): string => key[0]!.toUpperCase() + key.slice(1).replace(/_/g, " ");

const shown = (value: unknown): string => (typeof value === "number" ? String(value) : typeof value === "string" ? value : "");

/**
 * The session alone decides whether a value is allowed. A value that it refuses stays in the field, with the
 * reason below it, until the user corrects it; Escape brings back the value in effect.
 */
export class Field {
  readonly element: HTMLElement;
  private readonly input: HTMLInputElement | HTMLSelectElement;
  private readonly refusal = h("p", { class: "refusal", role: "alert", hidden: true });
  private value: unknown = null;

  /** `send` returns a promise that rejects with the reason when the value is refused. */
  constructor(private readonly setting: Setting, private readonly send: (value: Value) => Promise<unknown>) {
    const { key, doc, unit, kind, range, restarts } = setting;
    this.input = this.control();
    this.input.id = `setting-${key}`;
    this.input.setAttribute("aria-describedby", `help-${key}`);
    this.refusal.id = `refusal-${key}`;
    const help = [`${doc}.`, kind === "word" || !range ? "" : `Allowed: ${range}.`, restarts ? "A change restarts the simulation." : ""];
    this.element = h(
      "div", { class: "setting" },
      h("label", { for: this.input.id }, labelOf(key)), this.input, h("span", { class: "unit" }, [unit, restarts ? "restarts" : ""].filter(Boolean).join(", ")),
      h("p", { class: "hint", id: `help-${key}` }, help.filter(Boolean).join(" ")), this.refusal,
    );
    this.element.title = help.filter(Boolean).join(" ");
    this.input.addEventListener("change", () => this.commit());
    this.input.addEventListener("keydown", (event) => {
      if ((event as KeyboardEvent).key !== "Escape" || this.refusal.hidden) return;
      event.stopPropagation();
      this.show(this.value);
    });
  }

  private control(): HTMLInputElement | HTMLSelectElement {
    const { kind, words } = this.setting;
    if (kind === "truth") return h("input", { type: "checkbox" });
    if (kind !== "word") return h("input", { type: "text", inputmode: kind === "whole" ? "numeric" : "decimal", autocomplete: "off", spellcheck: "false" });
    return h("select", {}, ...words!.map((word) => h("option", { value: word }, word)));
  }

  /** Shows the value in effect. Keeps what the user is typing, and what was refused. */
  update(value: unknown): void {
    const isSame = value === this.value;
    this.value = value;
    if (!isSame || (this.refusal.hidden && document.activeElement !== this.input)) this.show(value);
  }

  private show(value: unknown): void {
    if (this.setting.kind === "truth") (this.input as HTMLInputElement).checked = value === true;
    else this.input.value = shown(value);
    this.refuse(null);
  }

  private refuse(reason: string | null): void {
    this.refusal.hidden = reason === null;
    this.refusal.textContent = reason ?? "";
    this.input.setAttribute("aria-invalid", String(reason !== null));
    if (reason !== null) this.input.setAttribute("aria-errormessage", this.refusal.id);
  }

  private get entered(): Value {
    const { kind } = this.setting;
    const text = this.input.value.trim();
    if (kind === "truth") return (this.input as HTMLInputElement).checked;
    return kind === "word" || !Number.isFinite(Number(text)) ? text : Number(text);
  }

  private commit(): void {
    if (this.input.value.trim() === "") return this.show(this.value);
    this.refuse(null);
    this.send(this.entered).catch((error: Error) => {
      const still = this.setting.kind === "truth" ? "" : ` The value stays ${typeof this.value === "number" ? readable(this.value) : shown(this.value)}.`;
      const reason = error.message.replace(/^\w+: /, "").replace(this.setting.key, labelOf(this.setting.key));
      if (this.setting.kind === "truth" || this.setting.kind === "word") this.show(this.value);
      this.refuse(`${reason}.${still}`);
    });
  }
}
