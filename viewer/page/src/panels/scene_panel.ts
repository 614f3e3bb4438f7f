/** The objects of the scene and the layers drawn over them. */
import { GAPS, levelColour, LEVELS } from "../colours";
import { FieldPanel } from "../fields/field_panel";
import type { Layer, Model } from "../model";
import { formOf } from "../protocol/lists";
import { LAYER_ROWS, type LayerRow } from "../view/styles";
import { h, readable } from "./dom";
import { ObjectList } from "./tables/object_list";
import { TouchLine } from "./touch_line";
import { ViewOptions } from "./view_options";

/** The text for a failure of the session: its message, and the layers that it switched off. */
export function sayFailure({ text, layers }: { text: string; layers: (Layer | "field")[] }): string {
  const labels = LAYER_ROWS.filter(({ layer }) => layers.includes(layer)).map(({ label }) => label);
  if (layers.includes("field")) labels.push("Field");
  return labels.length > 0 ? `${text}. Switched off: ${labels.join(", ")}.` : text;
}

function swatch(colour: string): HTMLElement {
  if (colour === "gaps") return swatchOf(GAPS);
  if (colour !== "levels") return h("span", { class: "swatch", style: colour ? `background:${colour}` : "visibility:hidden" });
  return swatchOf(LEVELS.slice(0, 4));
}

function swatchOf(four: string[]): HTMLElement {
  const stops = four.map((level, i) => `${level} ${i * 25}% ${i * 25 + 25}%`);
  return h("span", { class: "swatch", style: `background:linear-gradient(90deg,${stops.join(",")})` });
}

export class ScenePanel {
  readonly element: HTMLElement;
  private readonly counts = new Map<Layer, HTMLElement>();
  private readonly boxes = new Map<Layer, HTMLInputElement>();
  private readonly view: ViewOptions;
  private readonly rows = new Map<Layer, HTMLElement>();
  private readonly list = h("ul", { class: "layers", "aria-label": "Layers" });
  private readonly moreList = h("ul", { class: "layers", "aria-label": "More layers" });
  private readonly more = h("details", { class: "more" }, h("summary", {}, "More layers"), h("p", { class: "hint" }, "This scene has not produced them yet."), this.moreList);
  /** Layers that have had content since the scene was opened. */
  private seen = new Set<Layer>();
  private readonly only = h("input", { type: "checkbox" });
  private readonly levels = h("select", { "aria-label": "Octree level" });
  private readonly legend = h(
    "div", { class: "legend", hidden: true, title: "Colours of levels; they repeat after the last colour" },
    ...LEVELS.map((_, level) => h("span", { style: `--level:${levelColour(level)}` }, String(level))),
  );
  private readonly omitted = h("p", { class: "hint", role: "status", hidden: true });
  private deepest = -1;

  constructor(private readonly model: Model, frameObject: () => void) {
    this.view = new ViewOptions(model);
    this.element = h(
      "aside",
      { class: "panel left", "aria-label": "Scene" },
      h("section", {}, new TouchLine(model).element),
      new ObjectList(model, frameObject).element,
      new FieldPanel(model).element,
      h("section", {}, h("h2", {}, "Layers"), this.view.element, this.list, this.more, this.octreeOptions(), this.legend, this.omitted),
    );
    this.makeRows();
    model.on("scene", () => this.build());
    model.on("frame", () => this.sortRows());
    model.on("display", () => this.refresh());
  }

  private build(): void {
    this.deepest = -1;
    this.fitLevels(Math.max(0, this.model.octree.level));
    this.seen = new Set();
    this.sortRows();
  }

  /** Whether the scene fills a layer. When it tests other kinds of contacts, too, a layer of intersections waits for the first one. */
  private isProduced({ layer, lists = [], kinds = lists.map((list) => formOf(list).answers), has }: LayerRow): boolean {
    const { frame, scene } = this.model;
    if (frame && (has?.(frame) || lists.some((list) => frame.lists[list].count > 0))) this.seen.add(layer);
    if ((!has && lists.length === 0) || this.seen.has(layer)) return true;
    const asked = scene?.contacts.split(",") ?? [];
    return asked.some((kind) => kinds.includes(kind) && (kind !== "intersection" || asked.length === 1));
  }

  /** Moves the rows of layers that the scene does not produce to “More layers”. */
  private sortRows(): void {
    const lists = { main: [] as HTMLElement[], more: [] as HTMLElement[] };
    for (const row of LAYER_ROWS) lists[this.isProduced(row) ? "main" : "more"].push(this.rows.get(row.layer)!);
    if (lists.main.length === this.list.childElementCount && lists.main.every((row, i) => row === this.list.children[i])) return;
    const focus = document.activeElement;
    this.list.replaceChildren(...lists.main);
    this.moreList.replaceChildren(...lists.more);
    this.more.hidden = lists.more.length === 0;
    if (focus instanceof HTMLElement && this.element.contains(focus)) focus.focus();  // moving an element takes its focus away
  }

  private makeRows(): void {
    for (const { layer, label, key, colour, hint } of LAYER_ROWS) {
      const box = h("input", { type: "checkbox", "aria-label": label, "aria-keyshortcuts": key, onchange: () => this.model.setLayer(layer, box.checked) });
      box.checked = this.model.layers[layer];
      const count = h("span", { class: "count" });
      this.boxes.set(layer, box);
      this.counts.set(layer, count);
      this.rows.set(layer, h("li", {}, h("label", { title: `${hint} (${key})` }, box, swatch(colour), h("span", { class: "text" }, label), count, h("kbd", {}, key))));
    }
    this.sortRows();
  }

  private octreeOptions(): HTMLElement {
    const { only } = this;
    const request = () => {
      this.model.octree = { onlySelected: only.checked, level: Number(this.levels.value) };
      this.model.emit("request", null);
    };
    only.addEventListener("change", request);
    this.levels.addEventListener("change", request);
    return h(
      "div", { class: "options" },
      h("label", {}, "Level ", this.levels),
      h("label", { title: "Octree of the selected object only" }, only, "Selected only"),
    );
  }

  /** Offers levels up to the deepest level seen so far and the chosen one, which a view file may set before any frame. */
  private fitLevels(deepest: number): void {
    if (deepest <= this.deepest) return;
    this.deepest = deepest;
    const options = [h("option", { value: -1 }, "leaves")];
    for (let level = 0; level <= deepest; ++level) options.push(h("option", { value: level }, String(level)));
    this.levels.replaceChildren(...options);
    this.levels.value = String(this.model.octree.level);
  }

  private refresh(): void {
    const { layers, octree } = this.model;
    for (const [layer, box] of this.boxes) box.checked = layers[layer];
    this.only.checked = octree.onlySelected;
    this.fitLevels(octree.level);
    this.levels.value = String(octree.level);
    this.legend.hidden = !layers.octree && !layers.regions && !layers.nodes;
  }

  /** Shows the number of elements beside each layer, and whether surfaces are flat because they are too large. */
  showCounts(drawn: Record<string, number>, isFlat: boolean): void {
    this.view.sayFlat(isFlat && this.model.smooth);
    const { frame, layers } = this.model;
    const of: Record<string, number> = { ...drawn, octree: drawn["boxes"]! + drawn["balls"]!, nodes: drawn["nodeBoxes"]! + drawn["nodeBalls"]! };
    for (const [layer, element] of this.counts) {
      const count = of[layer];
      const text = layers[layer] && count !== undefined ? readable(count) : "";
      if (element.textContent !== text) element.textContent = text;
    }
    if (!frame) return;
    this.fitLevels(frame.text.octree_levels.reduce((deepest: number, level) => Math.max(deepest, level ?? 0), 0));
    const cut = Object.entries(frame.text.omitted);
    this.omitted.hidden = cut.length === 0;
    const text = cut.map(([name, count]) => `${name.replace(/_/g, " ")}: ${readable(count)} in all, the first are shown`).join("; ");
    if (this.omitted.textContent !== text) this.omitted.textContent = text;
  }
}
