/** How the scene is drawn: shading, x-ray, the upward axis. */
import type { Model } from "../model";
import { h } from "./dom";

export class ViewOptions {
  readonly element: HTMLElement;
  private readonly flat = h("p", { class: "hint", role: "status", hidden: true }, "Flat for now: more than 300,000 triangles move.");
  private readonly shown: (() => void)[] = [];

  constructor(private readonly model: Model) {
    this.element = h(
      "div", { class: "options", role: "group", "aria-label": "View" },
      this.box("Smooth", "Smooth shading; edges stay sharp", () => model.smooth, (on) => (model.smooth = on)),
      this.box("X-ray", "Makes all surfaces transparent", () => model.xray, (on) => (model.xray = on)),
      this.box("Z up", "The z axis points upward, otherwise the y axis", () => model.up === "z", (on) => (model.up = on ? "z" : "y")),
      this.flat,
    );
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

  private refresh(): void {
    for (const show of this.shown) show();
  }

  /** Says that surfaces are shaded flat although smooth shading is chosen. */
  sayFlat(isFlat: boolean): void {
    if (this.flat.hidden === isFlat) this.flat.hidden = !isFlat;
  }
}
