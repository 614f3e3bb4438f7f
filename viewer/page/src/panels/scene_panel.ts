/** The objects of the scene and the layers that are drawn over them. */
import { levelColour, LEVELS, OKABE_ITO } from "../colours";
import type { Layer, Model, ObjectState } from "../model";
import { h, readable } from "./dom";

interface LayerRow {
  layer: Layer;
  label: string;
  key: string;
  colour: string;
  hint: string;
}

export const LAYER_ROWS: LayerRow[] = [
  { layer: "surface", label: "Surfaces", key: "S", colour: "", hint: "The objects" },
  { layer: "wireframe", label: "Wireframe", key: "X", colour: "", hint: "The edges of all triangles" },
  { layer: "regions", label: "Scene octree", key: "N", colour: "levels", hint: "Regions of the broad phase, coloured by level" },
  { layer: "octree", label: "Object octrees", key: "B", colour: "levels", hint: "Cells of the objects' octrees, coloured by level" },
  { layer: "pairs", label: "Object pairs", key: "P", colour: OKABE_ITO.green, hint: "Objects whose volumes overlap" },
  { layer: "candidates", label: "Candidate pairs", key: "C", colour: OKABE_ITO.blue, hint: "Pairs of triangles that the exact stage decides" },
  { layer: "triangles", label: "Intersecting triangles", key: "I", colour: OKABE_ITO.vermillion, hint: "Triangles that have a contact" },
  { layer: "points", label: "Contact points", key: "D", colour: OKABE_ITO.yellow, hint: "The extreme points of what two triangles share" },
  { layer: "normals", label: "Contact normals", key: "Y", colour: OKABE_ITO.sky, hint: "The normal at each contact point" },
  { layer: "curves", label: "Intersection curves", key: "U", colour: "ink", hint: "Where surfaces cut through one another" },
  { layer: "vertices", label: "Colliding vertices", key: "J", colour: OKABE_ITO.purple, hint: "What the paper gives out: vertices of colliding octree nodes" },
];

function swatch(colour: string): HTMLElement {
  if (colour !== "levels") return h("span", { class: "swatch", style: colour ? `background:${colour === "ink" ? "var(--ink)" : colour}` : "visibility:hidden" });
  const stops = LEVELS.slice(0, 4).map((level, i) => `${level} ${i * 25}% ${i * 25 + 25}%`);
  return h("span", { class: "swatch", style: `background:linear-gradient(90deg,${stops.join(",")})` });
}

export class ScenePanel {
  readonly element: HTMLElement;
  private readonly list = h("ul", { class: "objects", "aria-label": "Objects" });
  private readonly counts = new Map<Layer, HTMLElement>();
  private readonly boxes = new Map<Layer, HTMLInputElement>();
  private readonly levels = h("select", { "aria-label": "Octree level" });
  private readonly legend = h(
    "div", { class: "legend", hidden: true, title: "Colours of levels; they begin again after the last" },
    ...LEVELS.map((_, level) => h("span", { style: `--level:${levelColour(level)}` }, String(level))),
  );
  private readonly omitted = h("p", { class: "hint", role: "status", hidden: true });
  private rows: HTMLLIElement[] = [];
  private deepest = -1;

  constructor(private readonly model: Model, private readonly frameObject: () => void) {
    this.element = h(
      "aside",
      { class: "panel left", "aria-label": "Scene" },
      h("section", { class: "grow" }, h("h2", {}, "Objects", this.allButton()), this.list),
      h("section", {}, h("h2", {}, "Layers"), this.layerList(), this.octreeOptions(), this.legend, this.omitted),
    );
    model.on("scene", () => this.build());
    model.on("selection", () => this.markSelected());
    model.on("display", () => this.refresh());
  }

  private allButton(): HTMLElement {
    const toggle = () => {
      const show = this.model.objects.some((object) => !object.visible);
      for (const object of this.model.objects) object.visible = show;
      this.build();
      this.changed();
    };
    return h("button", { type: "button", class: "link", title: "Show or hide all objects", onclick: toggle }, "all");
  }

  private changed(): void {
    this.model.emit("display", null);
    if (this.model.layers.octree) this.model.emit("request", null);
  }

  private build(): void {
    this.rows = this.model.objects.map((object) => this.objectRow(object));
    this.list.replaceChildren(...this.rows);
    this.markSelected();
    this.deepest = -1;
    this.fitLevels(0);
  }

  private objectRow(object: ObjectState): HTMLLIElement {
    const visible = h("input", {
      type: "checkbox", "aria-label": `Show ${object.name}`, title: "Show or hide",
      onchange: () => {
        object.visible = visible.checked;
        this.changed();
      },
    });
    visible.checked = object.visible;
    const colour = h("input", {
      type: "color", value: object.colour, "aria-label": `Colour of ${object.name}`, title: "Colour",
      oninput: () => {
        object.colour = colour.value;
        this.model.emit("display", null);
      },
    });
    const opacity = h("input", {
      type: "range", min: 0, max: 1, step: 0.05, value: object.opacity, class: "opacity", "aria-label": `Opacity of ${object.name}`, title: "Opacity",
      oninput: () => {
        object.opacity = opacity.valueAsNumber;
        this.model.emit("display", null);
      },
    });
    const name = h(
      "button",
      {
        type: "button", class: "name", title: `${object.name}: ${object.kind}, ${readable(object.vertices)} vertices, ${readable(object.triangles)} triangles. Double click frames it.`,
        onclick: () => this.model.select({ object: object.index, triangle: null, vertex: null }),
        ondblclick: () => this.frameObject(),
      },
      h("span", { class: "text" }, object.name),
      h("span", { class: "count" }, readable(object.triangles)),
    );
    return h("li", { "data-object": object.index }, visible, colour, name, opacity);
  }

  private markSelected(): void {
    const selected = this.model.selection?.object;
    this.rows.forEach((row, i) => {
      row.classList.toggle("selected", i === selected);
      row.querySelector(".name")!.setAttribute("aria-pressed", String(i === selected));
    });
    if (selected !== undefined) this.rows[selected]?.scrollIntoView({ block: "nearest" });
  }

  private layerList(): HTMLElement {
    const rows = LAYER_ROWS.map(({ layer, label, key, colour, hint }) => {
      const box = h("input", { type: "checkbox", "aria-label": label, "aria-keyshortcuts": key, onchange: () => this.model.setLayer(layer, box.checked) });
      box.checked = this.model.layers[layer];
      const count = h("span", { class: "count" });
      this.boxes.set(layer, box);
      this.counts.set(layer, count);
      return h("li", {}, h("label", { title: `${hint} (${key})` }, box, swatch(colour), h("span", { class: "text" }, label), count, h("kbd", {}, key)));
    });
    return h("ul", { class: "layers", "aria-label": "Layers" }, ...rows);
  }

  private octreeOptions(): HTMLElement {
    const request = () => {
      this.model.octree = { onlySelected: only.checked, level: Number(this.levels.value) };
      this.model.emit("request", null);
    };
    const only = h("input", { type: "checkbox", onchange: request });
    this.levels.addEventListener("change", request);
    return h(
      "div", { class: "options" },
      h("label", {}, "Level ", this.levels),
      h("label", { title: "Octree of the selected object only" }, only, "Selected only"),
    );
  }

  /** Levels to choose from, up to the deepest that a frame told of. */
  private fitLevels(deepest: number): void {
    if (deepest <= this.deepest) return;
    this.deepest = deepest;
    const chosen = String(this.model.octree.level);
    const options = [h("option", { value: -1 }, "leaves")];
    for (let level = 0; level <= deepest; ++level) options.push(h("option", { value: level }, String(level)));
    this.levels.replaceChildren(...options);
    this.levels.value = chosen;
    if (this.levels.selectedIndex < 0) this.levels.value = "-1";
  }

  private refresh(): void {
    const { layers } = this.model;
    for (const [layer, box] of this.boxes) box.checked = layers[layer];
    this.legend.hidden = !layers.octree && !layers.regions;
  }

  /** Counts beside the layers, of the newest frame. */
  showCounts(drawn: Record<string, number>): void {
    const { frame, layers } = this.model;
    const of: Partial<Record<Layer, number>> = {
      regions: drawn["regions"]!, octree: drawn["boxes"]! + drawn["balls"]!, candidates: drawn["candidates"]!, triangles: drawn["triangles"]!,
      points: drawn["points"]!, normals: drawn["normals"]!, curves: drawn["curves"]!, vertices: drawn["vertices"]!, pairs: drawn["pairs"]!,
    };
    for (const [layer, element] of this.counts) {
      const count = of[layer];
      const text = layers[layer] && count !== undefined ? readable(count) : "";
      if (element.textContent !== text) element.textContent = text;
    }
    if (!frame) return;
    this.fitLevels(Math.max(0, ...frame.text.octree_levels.map((level) => level ?? 0)));
    const cut = Object.entries(frame.text.omitted);
    this.omitted.hidden = cut.length === 0;
    const text = cut.map(([name, count]) => `${name.replace(/_/g, " ")}: ${readable(count)} in all, the first are shown`).join("; ");
    if (this.omitted.textContent !== text) this.omitted.textContent = text;
  }
}
