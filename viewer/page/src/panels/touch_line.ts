/** What touches in this frame. Its height is that of the longest text, so that nothing below it moves. */
import { Beginnings, isHit, isTouching, pairsOf, type TouchingPair } from "../contacts";
import type { Model } from "../model";
import { h, readable } from "./dom";

const pairs = (count: number): string => `${readable(count)} ${count === 1 ? "pair" : "pairs"}`;

export class TouchLine {
  readonly element = h("p", { class: "touch-line", role: "status", "aria-label": "What touches", "aria-live": "off" });
  private readonly beginnings = new Beginnings();

  constructor(private readonly model: Model) {
    model.on("scene", ({ contacts }) => this.element.style.setProperty("--lines", String(Math.max(2, contacts.split(",").length))));
    model.on("frame", () => this.update());
  }

  private update(): void {
    const frame = this.model.frame!;
    const all = pairsOf(frame);
    const began = this.beginnings.of(frame.text, all);
    const part = (word: string, some: TouchingPair[]) => {
      if (some.length === 0) return [];
      const fresh = some.filter(began).length;
      return [`${word}: ${pairs(some.length)}${fresh > 0 ? ` (${readable(fresh)} began)` : ""}`];
    };
    const touching = all.filter(isTouching);
    const hit = all.filter((pair) => !isTouching(pair) && isHit(pair));
    const near = all.filter((pair) => !isTouching(pair) && !isHit(pair));
    const parts = [...part("touching", touching), ...part("hit", hit), ...part("near", near)];
    const text = parts.length > 0 ? parts.join(" · ") : this.nothing();
    if (this.element.textContent !== text) this.element.textContent = text;
    this.element.dataset["state"] = touching.length + hit.length > 0 ? "touching" : near.length > 0 ? "near" : "apart";
  }

  /** An empty list is a result only when something was tested. */
  private nothing(): string {
    const { contacts } = this.model.scene!;
    const { lists, text: { untested } } = this.model.frame!;
    if (contacts === "none") return "nothing is tested: contacts are switched off";
    const tested = contacts.split(",").filter((kind) => !untested.some((entry) => entry.kind === kind));
    if (tested.length === 0) return `nothing was tested: ${[...new Set(untested.map(({ reason }) => reason.replace(/_/g, " ")))].join(", ")}`;
    const { count } = lists.object_pairs;
    return count > 0 ? `nothing touches: ${pairs(count)} tested` : "nothing touches: all are apart";
  }
}
