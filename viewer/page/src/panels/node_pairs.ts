/** The descent of the narrow phase into the octrees of two objects, level by level (Figure 4 of the paper). */
import type { Client } from "../client";
import { ALL_LEVELS, LEAVES, type Model } from "../model";
import { objectAt, SIDES } from "../records";
import { h, readable, refill } from "./dom";

/** Interval between updates while things move. */
const REFRESH_MILLISECONDS = 250;

interface Level {
  pairs: number;
  leaf_pairs: number;
  /** The first pairs: a node of each object, A(h, k). */
  names: [string, string][];
}

export class NodePairs {
  readonly element: HTMLElement;
  private readonly pairs = h("select", { "aria-label": "Object pair", onchange: () => void this.read() });
  private readonly levels = h("div", { class: "levels", role: "group", "aria-label": "Levels" });
  private readonly names = h("code", { role: "group", "aria-label": "Node pairs" });
  private answer: Level[] = [];
  private due: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly model: Model, private readonly client: Client) {
    this.element = h(
      "section", { class: "explain", "aria-label": "Narrow phase" },
      h("h3", {}, "Narrow phase"),
      h("p", { class: "hint" }, "Pairs of octree nodes (h, k) of two objects that collide, level by level. Choose a level to see its nodes."),
      this.pairs, this.levels, this.names,
    );
    model.on("scene", () => this.reset());
    model.on("frame", () => this.later());
    model.on("display", () => this.draw());
    new ResizeObserver(() => this.later()).observe(this.element);  // the tab was opened
  }

  private get objects(): [number, number] | null {
    return this.pairs.value === "" ? null : (this.pairs.value.split(" ").map(Number) as [number, number]);
  }

  private reset(): void {
    this.pairs.replaceChildren();
    this.answer = [];
    this.later();
  }

  private later(): void {
    this.due ??= setTimeout(() => {
      this.due = undefined;
      if (this.element.offsetParent === null) return;  // another tab is visible
      this.listPairs();
      void this.read();
    }, REFRESH_MILLISECONDS);
  }

  /** Offers the pairs of the broad phase, and the chosen pair as long as the scene is the same. */
  private listPairs(): void {
    const chosen = this.pairs.value;
    const found = this.model.frame?.lists.object_pairs;
    const values = Array.from({ length: found?.count ?? 0 }, (_, place) => SIDES.map((side) => objectAt(found!, side, place)).join(" "));
    if (chosen !== "" && !values.includes(chosen)) values.unshift(chosen);
    const name = (value: string) => value.split(" ").map((object) => this.model.objects[Number(object)]!.name).join(" and ");
    this.pairs.replaceChildren(h("option", { value: "" }, "two objects…"), ...values.map((value) => h("option", { value }, name(value))));
    this.pairs.value = chosen;
  }

  private async read(): Promise<void> {
    const { objects } = this;
    if (objects) {
      const answer = await this.client.ask({ do: "node_pairs", a: objects[0], b: objects[1] }).catch(() => null);
      this.answer = (answer?.["levels"] as Level[] | undefined) ?? [];
    } else this.answer = [];
    this.draw();
  }

  private draw(): void {
    const { objects, answer } = this;
    if (!objects) {
      refill(this.levels);
      this.names.textContent = "";
      return;
    }
    const { nodes, layers } = this.model;
    const isShown = (level: number) => layers.nodes && nodes.objects?.join(" ") === objects.join(" ") && nodes.level === level;
    const row = (level: number, label: string, pairs: number, leaves: number) =>
      h(
        "button", { type: "button", "aria-pressed": String(isShown(level)), onclick: () => this.toggle(level, isShown(level)) },
        h("span", {}, label), h("span", {}, `${readable(pairs)} pairs`), h("span", {}, leaves > 0 ? `${readable(leaves)} of leaves` : ""),
      );
    const sum = (count: (level: Level) => number) => answer.reduce((total, level) => total + count(level), 0);
    const leaves = sum((level) => level.leaf_pairs);
    refill(
      this.levels,
      ...answer.map((level, k) => row(k, `level ${k}`, level.pairs, level.leaf_pairs)),
      ...(answer.length > 0 ? [row(LEAVES, "leaves", leaves, leaves), row(ALL_LEVELS, "all levels", sum((level) => level.pairs), leaves)] : []),
    );
    const shown = answer.find((_, k) => isShown(k));
    const more = shown && shown.pairs > shown.names.length ? [`and ${readable(shown.pairs - shown.names.length)} more`] : [];
    this.names.textContent = answer.length === 0 ? "The broad phase does not report this pair." : [...(shown?.names.map((pair) => pair.join(" ")) ?? []), ...more].join("\n");
  }

  private toggle(level: number, isShown: boolean): void {
    if (isShown) this.model.setLayer("nodes", false);
    else this.model.showNodes({ objects: this.objects, level });
  }
}
