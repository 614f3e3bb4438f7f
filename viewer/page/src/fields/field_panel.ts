/** Chooses a field, its colours and the range that they cover. */
import type { Model } from "../model";
import { h } from "../panels/dom";
import type { FieldForm } from "../protocol/field_form";
import { isDiverging, MAPS, type MapName } from "./colour_maps";
import { rangeOf, readField } from "./fields";

const GROUPS: [element: FieldForm["element"], label: string][] = [["vertex", "Of vertices"], ["face", "Of triangles"], ["contact", "Of contacts"]];

export class FieldPanel {
  readonly element: HTMLElement;
  private readonly field = h("select", { "aria-label": "Field", onchange: () => this.model.setField({ key: this.field.value || null, range: null }) });
  private readonly map = h("select", { "aria-label": "Colour map", onchange: () => this.model.setField({ map: this.map.value as MapName }) });
  private readonly lock = h("input", { type: "checkbox", onchange: () => this.setLock() });
  private readonly ends = ["Lowest", "Highest"].map((label) => {
    const change = () => this.setRange();
    return h("input", { type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false", "aria-label": `${label} value`, onchange: change });
  });
  private readonly refusal = h("p", { class: "refusal", role: "alert", id: "refusal-range", hidden: true });
  private readonly arrows = h("input", { type: "range", min: 10, max: 120, step: 1, "aria-label": "Length of the longest arrow", oninput: () => this.model.setField({ arrowLength: this.arrows.valueAsNumber }) });
  private readonly arrowRow = h("label", {}, "Arrows ", this.arrows);
  private readonly doc = h("p", { class: "hint" });
  private readonly choices: HTMLElement;
  private offered = "";

  constructor(private readonly model: Model) {
    const lockLabel = h("label", { title: "Keeps the range while values change" }, this.lock, "Lock range");
    const ends = h("span", { class: "range", role: "group", "aria-label": "Range" }, this.ends[0]!, "to", this.ends[1]!);
    this.map.append(...MAPS.map((map) => h("option", { value: map }, isDiverging(map) ? `${map} (0 in the middle)` : map)));
    this.choices = h("div", { class: "choices" }, this.map, lockLabel, ends, this.refusal, this.arrowRow, this.doc);
    this.element = h("section", { class: "field-panel" }, h("h2", {}, "Field"), this.field, this.choices);
    for (const input of this.ends)
      input.addEventListener("keydown", (event) => {
        if (event.key !== "Escape" || this.refusal.hidden) return;
        event.stopPropagation();
        this.refuse("");
        this.ends.forEach((end, i) => (end.value = String(this.model.field.range?.[i] ?? "")));
      });
    for (const event of ["scene", "frame", "display"] as const) model.on(event, () => this.update());
  }

  private update(): void {
    const { scene, field } = this.model;
    this.offer(scene?.fields ?? []);
    const form = scene?.fields.find(({ key }) => key === field.key);
    this.field.value = form?.key ?? "";
    this.choices.hidden = !form;
    if (!form) return;
    this.map.value = field.map;
    this.lock.checked = field.range !== null;
    this.arrowRow.hidden = !form.vector;
    this.arrows.value = String(field.arrowLength);
    this.ends.forEach((input, i) => {
      input.parentElement!.hidden = field.range === null;
      if (field.range && this.refusal.hidden && document.activeElement !== input) input.value = String(field.range[i]);
    });
    const doc = form.doc && `${form.doc}.`;
    if (this.doc.textContent !== doc) this.doc.textContent = doc;
  }

  /** Lists the fields of the scene. */
  private offer(fields: FieldForm[]): void {
    const offered = JSON.stringify(fields.map(({ key, label }) => [key, label]));
    if (offered === this.offered) return;
    this.offered = offered;
    const groups = GROUPS.flatMap(([element, label]) => {
      const options = fields.filter((form) => form.element === element).map((form) => h("option", { value: form.key, title: form.doc }, form.label));
      return options.length > 0 ? [h("optgroup", { label }, ...options)] : [];
    });
    this.field.replaceChildren(h("option", { value: "" }, "none"), ...groups);
  }

  /** Locks the range that is shown at present. */
  private setLock(): void {
    this.refuse("");
    if (!this.lock.checked) return this.model.setField({ range: null });
    const data = readField(this.model);
    const [low, high] = data ? rangeOf(data, this.model.field) : [0, 1];
    this.model.setField({ range: high > low ? [low, high] : [low, low + 1] });
  }

  private setRange(): void {
    const [low, high] = this.ends.map(({ value }) => (value.trim() === "" ? NaN : Number(value))) as [number, number];
    const [lowest, highest] = this.model.field.range!;
    const stays = `The range stays ${lowest} to ${highest}.`;
    if (!Number.isFinite(low) || !Number.isFinite(high)) return this.refuse(`Both ends must be numbers. ${stays}`);
    if (!(low < high)) return this.refuse(`The lowest value must be below the highest. ${stays}`);
    this.refuse("");
    this.model.setField({ range: [low, high] });
  }

  private refuse(reason: string): void {
    this.refusal.hidden = reason === "";
    this.refusal.textContent = reason;
    for (const input of this.ends) {
      input.setAttribute("aria-invalid", String(reason !== ""));
      if (reason) input.setAttribute("aria-errormessage", this.refusal.id);
    }
  }
}
