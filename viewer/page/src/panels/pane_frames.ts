/** The outline of the active one of several views. */
import type { Panes } from "../view/panes";
import { h } from "./dom";

export class PaneFrames {
  readonly element = h("div", { class: "panes", hidden: true, "aria-hidden": "true" }, h("div"));

  constructor(private readonly canvas: HTMLElement, private readonly panes: Panes) {
    new ResizeObserver(() => this.update()).observe(canvas);
    this.update();
  }

  update(): void {
    const { shown, active, layout } = this.panes;
    this.element.hidden = layout === 1;
    const frame = this.element.firstElementChild as HTMLElement;
    for (const [side, length] of Object.entries(active.area)) frame.style.setProperty(side, `${length}px`);
    this.canvas.setAttribute("aria-label", layout === 1 ? "3D view" : `3D view, ${shown.indexOf(active) + 1} of ${layout} is active`);
  }
}
