/** The objects of the scene and the layers drawn over them. */
import { levelColour, LEVELS, OKABE_ITO } from "../colours";
import type { Layer, Model } from "../model";
import { h, readable } from "./dom";
import { ObjectList } from "./object_list";

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
  { layer: "regions", label: "Scene octree", key: "N", colour: "levels", hint: "Regions that the broad phase used in this frame, coloured by level; none unless the octree ran" },
  { layer: "octree", label: "Object octrees", key: "B", colour: "levels", hint: "Cells of the objects' octrees, coloured by level" },
  { layer: "nodes", label: "Colliding nodes", key: "K", colour: "levels", hint: "Nodes of two octrees whose volumes overlap in the narrow phase: the leaves, or a level chosen under Narrow phase" },
  { layer: "pairs", label: "Object pairs", key: "P", colour: OKABE_ITO.green, hint: "Objects whose volumes overlap" },
  { layer: "candidates", label: "Candidate pairs", key: "C", colour: OKABE_ITO.blue, hint: "Pairs of triangles that the exact stage decides" },
  { layer: "triangles", label: "Intersecting triangles", key: "I", colour: OKABE_ITO.vermillion, hint: "Triangles that have a contact" },
  { layer: "points", label: "Contact points", key: "D", colour: OKABE_ITO.yellow, hint: "Extreme points of the intersection of two triangles" },
  { layer: "normals", label: "Contact normals", key: "Y", colour: OKABE_ITO.sky, hint: "The normal at each contact point" },
  { layer: "segments", label: "Contact segments", key: "U", colour: "ink", hint: "Segments and outlines in which pairs of triangles intersect" },
  { layer: "proximity", label: "Proximity pairs", key: "M", colour: "proximity", hint: "Closest points within the margins, coloured by distance: vermillion up to a quarter of the margins, then orange, green and blue" },
  { layer: "depths", label: "Depths", key: "E", colour: OKABE_ITO.purple, hint: "From each vertex inside a solid object to the closest point of its surface" },
  { layer: "curves", label: "Curves", key: "A", colour: OKABE_ITO.green, hint: "The triangles at the vertices that each curve of intersections encloses, and an arrow along the normal, as far as the first object must move to pass the second" },
  { layer: "vertices", label: "Colliding vertices", key: "J", colour: OKABE_ITO.purple, hint: "The output of the paper: vertices of colliding octree nodes" },
];

function swatch(colour: string): HTMLElement {
  if (colour === "proximity") return swatchOf([5, 1, 2, 0].map(levelColour));
  if (colour !== "levels") return h("span", { class: "swatch", style: colour ? `background:${colour === "ink" ? "var(--ink)" : colour}` : "visibility:hidden" });
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
  private readonly levels = h("select", { "aria-label": "Octree level" });
  private readonly legend = h(
    "div", { class: "legend", hidden: true, title: "Colours of levels; they repeat after the last colour" },
    ...LEVELS.map((_, level) => h("span", { style: `--level:${levelColour(level)}` }, String(level))),
  );
  private readonly omitted = h("p", { class: "hint", role: "status", hidden: true });
  private deepest = -1;

  constructor(private readonly model: Model, frameObject: () => void) {
    this.element = h(
      "aside",
      { class: "panel left", "aria-label": "Scene" },
      new ObjectList(model, frameObject).element,
      h("section", {}, h("h2", {}, "Layers"), this.layerList(), this.octreeOptions(), this.legend, this.omitted),
    );
    model.on("scene", () => this.build());
    model.on("display", () => this.refresh());
  }

  private build(): void {
    this.deepest = -1;
    this.fitLevels(0);
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

  /** Offers levels up to the deepest level seen so far. */
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
    this.legend.hidden = !layers.octree && !layers.regions && !layers.nodes;
  }

  /** Shows the number of drawn elements beside each layer. */
  showCounts(drawn: Record<string, number>): void {
    const { frame, layers } = this.model;
    const of: Partial<Record<Layer, number>> = {
      regions: drawn["regions"]!, octree: drawn["boxes"]! + drawn["balls"]!, nodes: drawn["nodeBoxes"]! + drawn["nodeBalls"]!, candidates: drawn["candidates"]!, triangles: drawn["triangles"]!,
      points: drawn["points"]!, normals: drawn["normals"]!, segments: drawn["segments"]!, proximity: drawn["proximity"]!, depths: drawn["depths"]!, curves: drawn["curves"]!, vertices: drawn["vertices"]!, pairs: drawn["pairs"]!,
    };
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
