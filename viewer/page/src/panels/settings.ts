/** The options of the session, and those of the drawing. */
import type { Client } from "../client";
import type { Model } from "../model";
import type { Setting } from "../protocol/messages";
import { h } from "./dom";
import { Field } from "./field";

/** The options that come first; all others are folded. */
const FIRST = ["bounding_volume", "broad_phase", "contacts", "max_level", "leaf_size"];

export class Settings {
  readonly element: HTMLElement;
  private readonly detection = h("fieldset");
  private readonly chosen = h("p", { class: "hint" }, "The program chooses its options. Go back to a past step to try others.");
  private readonly fields = new Map<string, Field>();
  private described = "";

  constructor(private readonly model: Model, private readonly client: Client) {
    this.element = h("div", { class: "settings" }, this.detection, h("h3", {}, "Drawing"), ...this.drawing());
    model.on("scene", () => this.update());
    model.on("frame", () => this.allow());
  }

  private update(): void {
    const scene = this.model.scene!;
    const described = JSON.stringify(scene.settings);
    if (described !== this.described) this.build(scene.settings);
    this.described = described;
    this.allow();
    for (const [key, field] of this.fields) field.update(key === "objects" ? scene.objects.length : (scene as unknown as Record<string, unknown>)[key]);
  }

  /** The program chooses its options, but not those with which a past step is detected again. */
  private allow(): void {
    const isChosen = this.model.scene?.source === "program" && !this.model.frame?.text.past;
    if (this.detection.disabled !== isChosen) this.detection.disabled = isChosen;
    this.chosen.hidden = !isChosen;
  }

  private build(settings: Setting[]): void {
    this.fields.clear();
    const list = (wanted: (setting: Setting) => boolean) =>
      settings.filter((setting) => setting.kind !== "cube" && wanted(setting)).map((setting) => {
        const field = new Field(setting, (value) => this.client.ask({ do: "set", [setting.key]: value }));
        this.fields.set(setting.key, field);
        return field.element;
      });
    const restarting = list(({ restarts }) => restarts);
    this.detection.hidden = settings.length === 0;
    this.detection.replaceChildren(
      h("h3", {}, "Collision detection"), this.chosen,
      ...list(({ key }) => FIRST.includes(key)),
      h("details", {}, h("summary", {}, "More options"), ...list(({ key, restarts }) => !restarts && !FIRST.includes(key))),
      ...(restarting.length > 0 ? [h("h3", {}, "Simulation"), h("p", { class: "hint" }, "A change here restarts the simulation."), ...restarting] : []),
    );
  }

  private drawing(): HTMLElement[] {
    const { model } = this;
    const changed = () => model.emit("display", null);
    const through = h("input", { type: "checkbox", id: "through", onchange: () => {
      model.throughSurfaces = through.checked;
      changed();
    } });
    const slider = (name: "pointSize" | "normalLength", label: string, min: number, max: number, step: number) => {
      const input = h("input", { type: "range", id: name, min, max, step, oninput: () => {
        model[name] = input.valueAsNumber;
        changed();
      } });
      model.on("display", () => (input.value = String(model[name])));
      input.value = String(model[name]);
      return h("div", { class: "setting" }, h("label", { for: name }, label), input);
    };
    model.on("display", () => (through.checked = model.throughSurfaces));
    through.checked = model.throughSurfaces;
    return [
      h("div", { class: "setting" }, h("label", { for: "through" }, "Marks through surfaces"), through),
      slider("pointSize", "Point size", 2, 20, 1), slider("normalLength", "Normal length", 8, 80, 1),
    ];
  }
}
