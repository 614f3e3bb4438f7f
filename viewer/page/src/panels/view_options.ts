/** How the scene is drawn: shading, x-ray, a slice, the upward axis. */
import type { Model, SliceChoice } from "../model";
import { MOST_SMOOTH } from "../view/surfaces";
import { h, readable } from "./dom";

export class ViewOptions {
  readonly element: HTMLElement;
  private readonly flat = h("p", { class: "hint", role: "status", hidden: true }, `Flat for now: more than ${readable(MOST_SMOOTH)} triangles move.`);
  private readonly shown: (() => void)[] = [];

  constructor(private readonly model: Model) {
    this.element = h(
      "div", { class: "options", role: "group", "aria-label": "View" },
      this.box("Smooth", "Smooth shading; edges stay sharp", () => model.smooth, (on) => (model.smooth = on)),
      this.box("Occlusion", "Ambient occlusion: darkens creases and narrow gaps. Off without a graphics card, and when drawing is slow", () => model.occlusion, (on) => (model.occlusion = on)),
      this.box("X-ray", "Makes all surfaces transparent", () => model.xray, (on) => (model.xray = on)),
      this.box("Z up", "The z axis points upward, otherwise the y axis", () => model.up === "z", (on) => (model.up = on ? "z" : "y")),
      this.box("Values at pointer", "Rest the pointer on a surface or a mark, or press it long with a finger, to see its values", () => model.hover, (on) => (model.hover = on)),
      this.sliceField(),
      this.flat,
    );
    this.refresh();
    model.on("display", () => this.refresh());
    model.on("scene", () => this.refresh());
  }

  private box(label: string, title: string, get: () => boolean, set: (on: boolean) => void): HTMLElement {
    const box = h("input", { type: "checkbox", onchange: () => {
      set(box.checked);
      this.model.emit("display", null);
    } });
    this.shown.push(() => (box.checked = get()));
    box.checked = get();
    return h("label", { title }, box, label);
  }

  /** The axis of the slice, and where it cuts and which side is removed. */
  private sliceField(): HTMLElement {
    const { model } = this;
    const changed = () => model.emit("display", null);
    const axis = h("select", { "aria-label": "Slice", onchange: () => {
      model.slice.axis = axis.value as SliceChoice["axis"];
      changed();
    } }, ...(["off", "x", "y", "z"] as const).map((name) => h("option", { value: name }, name === "off" ? "no slice" : `slice in ${name}`)));
    const at = h("input", { type: "range", min: 0, max: 1, step: "any", "aria-label": "Position of the slice", oninput: () => {
      model.slice.at = at.valueAsNumber;
      changed();
    } });
    const flip = h("button", { type: "button", class: "link", title: "Remove the other side", onclick: () => {
      model.slice.flipped = !model.slice.flipped;
      changed();
    } }, "flip");
    this.shown.push(() => {
      axis.value = model.slice.axis;
      if (at.valueAsNumber !== model.slice.at) at.valueAsNumber = model.slice.at;
      at.hidden = flip.hidden = model.slice.axis === "off";
    });
    return h("span", { class: "slice", title: "Cuts all surfaces open. Closed surfaces have caps, which are red where objects overlap." }, axis, at, flip);
  }

  private refresh(): void {
    for (const show of this.shown) show();
  }

  /** Says that surfaces are shaded flat although smooth shading is chosen. */
  sayFlat(isFlat: boolean): void {
    if (this.flat.hidden === isFlat) this.flat.hidden = !isFlat;
  }
}
