/** The state of the page: the scene, the newest frame, and the user's choices. */
import type { Bounds } from "./bounds";
import { objectColour } from "./colours";
import { sidesOf, type ContactKey } from "./contacts";
import { Emitter } from "./emitter";
import { firstChoice, type FieldChoice } from "./fields/fields";
import { eventsOf, History } from "./history";
import { EVENT_KINDS, type FrameMessage, type SceneMessage, type SceneObject, type SceneText, type SeriesMessage } from "./protocol/messages";
import viewMembers from "./protocol/view_members_generated.json";
import { shiftFrame, shiftOf } from "./shift";

export interface ObjectState {
  index: number;
  name: string;
  vertices: number;
  triangles: number;
  isStatic: boolean;
  isBody: boolean;
  /** Its kind of motion, in a word or two. */
  kind: string;
  /** Current positions minus the scene's centre: a view into the model's `positions`. */
  positions: Float32Array;
  /** The vertices of all elements, three for each: triangles, then edges and points, which repeat a vertex. */
  corners: Uint32Array;
  /** Edges and points of no triangle: rods and particles. */
  edges: Uint32Array;
  points: Uint32Array;
  /** In the active view, or in the one that is drawn. */
  visible: boolean;
  /** In each view. */
  visibleIn: boolean[];
  colour: string;
  opacity: number;
  /** A cache for `boundsOf`, valid for the current positions. */
  bounds?: Bounds | null | undefined;
}

/** The plane that cuts surfaces open. */
export interface SliceChoice {
  axis: "off" | "x" | "y" | "z";
  /** Where along the axis, from 0 to 1. */
  at: number;
  /** Whether the other side is removed. */
  flipped: boolean;
}

/** Views of the scene beside each other. */
export const MOST_VIEWS = 4;

type LayerPath = Extract<keyof typeof viewMembers, `layers.${string}`>;
export type Layer = LayerPath extends `layers.${infer Name}` ? Name : never;
export const LAYERS = Object.keys(viewMembers).flatMap((path) => (path.startsWith("layers.") ? [path.slice(7) as Layer] : []));
const OFF_AT_FIRST: Layer[] = ["wireframe", "regions", "octree", "nodes", "pairs", "candidates", "normals", "vertices"];

/** Layers that the session computes, by their names in the protocol. */
const MADE_BY_SESSION: Record<string, Layer> = { candidates: "candidates", scene_regions: "regions", colliding_vertices: "vertices", octree: "octree", colliding_nodes: "nodes" };

export const TOOLS = ["select", "grab", "explain"] as const;
export type Tool = (typeof TOOLS)[number];

export interface Selection {
  object: number;
  triangle: number | null;
  vertex: number | null;
}

export interface Measurement {
  distance: number;
  points: [number[], number[]];
}

export interface Explanation {
  stage: string;
  text: string;
  boxes: [number[][], number[][]] | null;
  spheres: number[][] | null;
  /** For each side the edges of its oriented box or k-DOP. */
  edges: number[][][][] | null;
  levels: number[] | null;
  axis: number[] | null;
  distance: number | null;
  /** The ruler: the nearest points of the two objects; null for one object. */
  nearest: Measurement | null;
}

/** The colliding nodes to draw: of two objects or of all pairs, on one level. */
export interface NodeChoice {
  objects: [number, number] | null;
  level: number;
}
export const LEAVES = -1;
export const ALL_LEVELS = -2;

interface ModelEvents {
  scene: SceneText;
  frame: FrameMessage;
  /** The appearance changed: visibility, colour, opacity, layers or theme. */
  display: null;
  /** The set of layers that the session must send changed. */
  request: null;
  selection: null;
  tool: Tool;
  explanation: null;
  history: null;
  /** An object was pulled. */
  pulled: null;
}

/** The look of an object that nobody has changed. Objects of a second recording lie over those of the first. */
export function usualLook({ comparison }: SceneText, index: number): { visible: true; colour: string; opacity: number } {
  const isSecond = comparison !== null && index >= comparison.objects_of_a;
  return { visible: true, colour: objectColour(isSecond ? index - comparison.objects_of_a : index), opacity: isSecond ? 0.5 : 1 };
}

function kindOf(object: SceneObject, source: SceneText["source"]): string {
  if (object.static) return "static";
  if (object.removed) return "removed";
  if (source === "program") return "moved by the program";
  if (source === "recording") return "recorded";
  if (object.body) return "soft body";
  if (object.rigid) return "rigid";
  return object.waves ? "swaying" : "at rest";
}

function elementsOf(message: SceneMessage, object: number): Pick<ObjectState, "corners" | "edges" | "points"> {
  const of = (list: Map<number, Uint32Array>) => list.get(object) ?? new Uint32Array(0);
  const [triangles, edges, points] = [of(message.triangles), of(message.edges), of(message.points)];
  if (edges.length + points.length === 0) return { corners: triangles, edges, points };
  const corners = new Uint32Array(triangles.length + (3 * edges.length) / 2 + 3 * points.length);
  corners.set(triangles);
  let at = triangles.length;
  for (let i = 0; i < edges.length; i += 2) {
    corners.set([edges[i]!, edges[i + 1]!, edges[i + 1]!], at);
    at += 3;
  }
  for (const point of points) corners.fill(point, at, (at += 3));
  return { corners, edges, points };
}

export class Model extends Emitter<ModelEvents> {
  scene: SceneText | null = null;
  objects: ObjectState[] = [];
  /** All objects, one after the other. */
  positions = new Float32Array(0);
  frame: FrameMessage | null = null;
  framesSeen = 0;
  readonly history = new History();

  layers = Object.fromEntries(LAYERS.map((layer) => [layer, !OFF_AT_FIRST.includes(layer)])) as Record<Layer, boolean>;
  octree: { onlySelected: boolean; level: number } = { onlySelected: false, level: -1 };
  nodes: NodeChoice = { objects: null, level: LEAVES };
  throughSurfaces = true;
  /** Whether surfaces are shaded smooth. */
  smooth = true;
  /** Whether creases and gaps are dark. Off without a graphics card, and when drawing is slow. */
  occlusion = false;
  /** Whether surfaces are so transparent that everything inside is visible. */
  xray = false;
  /** Of each view. */
  slices: SliceChoice[] = Array.from({ length: MOST_VIEWS }, () => ({ axis: "off", at: 0.5, flipped: false }));
  /** The active view, or the one that is drawn: `slice` and the visibility of objects are its own. */
  view = 0;
  /** How many views are shown. */
  viewCount = 1;
  /** The upward axis. */
  up: "y" | "z" = "y";
  /** Whether the resting pointer shows values. */
  hover = true;
  pointSize = 5;
  normalLength = 24;  // in CSS pixels
  /** Part of the names of objects: the list of contacts has only objects with it. */
  filter = "";
  field = firstChoice();

  tool: Tool = "select";
  selection: Selection | null = null;
  contact: ContactKey | null = null;
  explained: { object: number; triangle: number }[] = [];
  explanation: Explanation | null = null;
  wasPulled = false;  // in this run
  /** How far the objects of a second recording stand beside the first; 0 over them. */
  shift = 0;

  takeScene(message: SceneMessage): void {
    const before = this.scene;
    const old = this.objects;
    this.scene = message.text;
    this.frame = null;
    if (!message.text.comparison) this.shift = 0;
    this.positions = new Float32Array(3 * message.text.objects.reduce((sum, object) => sum + object.vertices, 0));
    let first = 0;
    const model = this;
    this.objects = message.text.objects.map((object, index) => {
      const kept = old[index]?.name === object.name ? old[index] : undefined;
      const look = usualLook(message.text, index);
      return {
        index,
        name: object.name,
        vertices: object.vertices,
        triangles: object.triangles,
        isStatic: object.static,
        isBody: object.body,
        kind: kindOf(object, message.text.source),
        positions: this.positions.subarray(first, (first += 3 * object.vertices)),
        ...elementsOf(message, index),
        visibleIn: kept?.visibleIn ?? new Array<boolean>(MOST_VIEWS).fill(true),
        get visible() {
          return this.visibleIn[model.view]!;
        },
        set visible(on) {
          this.visibleIn[model.view] = on;
        },
        colour: kept?.colour ?? look.colour,
        opacity: kept?.opacity ?? look.opacity,
      };
    });
    const sameObjects =
      before?.title === message.text.title && old.length === this.objects.length &&
      old.every((object, i) => object.triangles === this.objects[i]!.triangles);
    if (!sameObjects) this.selection = null;
    this.explained = [];
    this.explanation = null;
    this.contact = null;
    if (this.nodes.objects?.some((object) => object >= this.objects.length)) this.nodes = { objects: null, level: LEAVES };
    const names = message.text.source === "recording" ? message.text.series : ["time", ...message.text.statistics];
    const goesOn = before?.title === message.text.title && before.run === message.text.run && names.join() === this.history.names.join();
    if (!goesOn) {
      this.history.reset(names);
      this.wasPulled = false;
    }
    this.emit("scene", message.text);
    this.emit("explanation", null);
  }

  takeFrame(message: FrameMessage): void {
    if (!this.scene || message.text.generation !== this.scene.generation) return;
    for (const [index, positions] of message.positions) {
      const object = this.objects[index]!;
      object.positions.set(positions);
      object.bounds = undefined;
      if (this.isShifted(index)) this.shiftObject(object, this.shift);
    }
    if (this.shift !== 0) shiftFrame(message, this.scene.comparison!.objects_of_a, this.shift);
    this.frame = message;
    this.framesSeen += 1;
    if (this.scene.source !== "recording" && !message.text.past) this.remember(message);
    this.emit("frame", message);
  }

  /** The first and the last step that can be shown: of a recording, or those that a session keeps. */
  get range(): [number, number] {
    return this.frame?.text.range ?? [0, (this.scene?.frames ?? 1) - 1];
  }

  takeSeries(message: SeriesMessage): void {
    const width = this.history.names.length;
    this.history.reset(this.history.names);
    const rows = width === 0 ? 0 : message.values.length / width;
    for (let c = 0; c < width; ++c) {
      const column = new Array<number>(rows);
      for (let row = 0; row < rows; ++row) column[row] = message.values[row * width + c]!;
      this.history.columns[c] = column;
    }
    this.history.frames = Array.from({ length: rows }, (_, row) => row);
    for (const kind of EVENT_KINDS)
      this.history.events[kind] = { begin: eventsOf(message.events[kind].begin), end: eventsOf(message.events[kind].end) };
    this.emit("history", null);
  }

  get slice(): SliceChoice {
    return this.slices[this.view]!;
  }

  /** Calls `look` with `slice` and the visibility of a view. */
  inView<Result>(view: number, look: () => Result): Result {
    const active = this.view;
    this.view = view;
    try {
      return look();
    } finally {
      this.view = active;
    }
  }

  /** A view begins with the slice and the objects of another one. */
  copyView(from: number, to: number): void {
    this.slices[to] = { ...this.slices[from]! };
    for (const { visibleIn } of this.objects) visibleIn[to] = visibleIn[from]!;
  }

  /** Whether two views show the same objects. */
  showsSame(view: number, other: number): boolean {
    return view === other || this.objects.every(({ visibleIn }) => visibleIn[view] === visibleIn[other]);
  }

  private isShifted(index: number): boolean {
    return this.shift !== 0 && index >= this.scene!.comparison!.objects_of_a;
  }

  private shiftObject(object: ObjectState, by: number): void {
    for (let i = 0; i < object.positions.length; i += 3) object.positions[i]! += by;
    object.bounds = undefined;
  }

  /** Sets the objects of the second recording beside those of the first, or over them. */
  setSideBySide(on: boolean): void {
    const { scene, frame } = this;
    const shift = on && scene?.comparison ? shiftOf(scene) : 0;
    const by = shift - this.shift;
    if (by === 0) return;
    const first = scene!.comparison!.objects_of_a;
    for (const object of this.objects) if (object.index >= first) this.shiftObject(object, by);
    this.shift = shift;
    if (!frame) return;
    shiftFrame(frame, first, by);
    for (const { index, positions } of this.objects) if (index >= first) frame.positions.set(index, new Float32Array(positions));
    this.emit("frame", frame);
  }

  /** Adds the steps since the last frame, with their events. */
  private remember({ text: { step, time }, steps, events }: FrameMessage): void {
    const { history } = this;
    if (step === history.last) return;  // the same step again, with other layers or options
    if (step < history.last) history.reset(history.names);  // another program
    const known = history.last;
    const width = history.names.length - 1;
    const count = steps.length / width;
    for (let i = 0; i < count; ++i) {
      const at = step - (count - 1 - i);
      if (at > history.last) history.push(at, time - (step - at) * this.scene!.time_step, steps.subarray(i * width, (i + 1) * width));
    }
    for (const kind of EVENT_KINDS)
      for (const side of ["begin", "end"] as const) {
        const list = history.events[kind][side];
        for (const event of eventsOf(events[kind][side])) if (event.frame > known) list.push(event);
      }
    this.emit("history", null);
  }

  /** The unit of lengths; empty when the scene has none. */
  get unit(): string {
    return this.objects.some(({ isBody, kind }) => isBody || kind === "rigid") ? "m" : "";
  }

  /** Whether time changes anything. */
  get moves(): boolean {
    const { scene } = this;
    if (scene?.source === "program") return true;
    return scene !== null && (scene.frames === null ? scene.objects.some(({ body, waves, rigid }) => body || waves || rigid) : scene.frames > 1);
  }

  can(command: string): boolean {
    return this.scene?.can.includes(command) ?? false;
  }

  select(selection: Selection | null, contact: ContactKey | null = null): void {
    this.selection = selection;
    this.contact = contact;
    this.emit("selection", null);
    if (this.layers.octree && this.octree.onlySelected) this.emit("request", null);
  }

  /** Selects a contact, and the touching part of object a. */
  selectContact(key: ContactKey): void {
    const [a] = sidesOf(key);
    this.select({ object: a.object, triangle: a.kind === "face" ? a.elements[0]! : null, vertex: null }, key);
  }

  clearSelection(): void {
    this.explained = [];
    this.explanation = null;
    this.select(null);
  }

  setPulled(): void {
    this.wasPulled = true;
    this.emit("pulled", null);
  }

  setTool(tool: Tool): void {
    this.tool = tool;
    if (tool !== "explain") this.setExplained([], null);
    this.emit("tool", tool);
  }

  setExplained(triangles: { object: number; triangle: number }[], explanation: Explanation | null): void {
    this.explained = triangles;
    this.explanation = explanation;
    this.emit("explanation", null);
  }

  setLayer(layer: Layer, on: boolean): void {
    this.layers[layer] = on;
    if (Object.values(MADE_BY_SESSION).includes(layer)) this.emit("request", null);
    this.emit("display", null);
  }

  showNodes(nodes: NodeChoice): void {
    this.nodes = nodes;
    this.setLayer("nodes", true);
  }

  setField(choice: Partial<FieldChoice>): void {
    const isOther = choice.key !== undefined && choice.key !== this.field.key;
    this.field = { ...this.field, ...choice };
    if (isOther) this.emit("request", null);
    this.emit("display", null);
  }

  /**
   * Switches off layers that the session can no longer compute, by their names in the protocol; returns
   * those that were on. Then requests the others again, because a request may have been in transit.
   */
  dropLayers(names: string[]): (Layer | "field")[] {
    const dropped: (Layer | "field")[] = [];
    for (const layer of names.flatMap((name) => MADE_BY_SESSION[name] ?? []).filter((layer) => this.layers[layer])) {
      this.layers[layer] = false;
      dropped.push(layer);
    }
    if (names.includes("field") && this.field.key !== null) {
      this.field.key = null;
      dropped.push("field");
    }
    this.emit("request", null);
    this.emit("display", null);
    return dropped;
  }

  /** The `layers` command for the layers that are switched on. */
  request(): Record<string, unknown> {
    const objects =
      this.octree.onlySelected && this.selection
        ? [this.selection.object]
        : this.objects.filter(({ visibleIn }) => visibleIn.slice(0, this.viewCount).includes(true)).map((object) => object.index);
    return {
      do: "layers",
      candidates: this.layers.candidates,
      scene_regions: this.layers.regions,
      colliding_vertices: this.layers.vertices,
      colliding_nodes: this.layers.nodes ? { level: this.nodes.level, ...(this.nodes.objects && { objects: this.nodes.objects }) } : null,
      octree: this.layers.octree ? { objects, level: this.octree.level } : null,
      field: this.scene?.fields.some(({ key }) => key === this.field.key) ? this.field.key : null,
    };
  }
}
