/**
 * What the user chose: camera, layers, marks, objects and panels, as one object that JSON can hold. The
 * browser keeps it for each scene, so that it survives a reload and a restart of the program.
 */
import { objectColour } from "./colours";
import { MAPS } from "./fields/colour_maps";
import type { FieldChoice } from "./fields/fields";
import { LAYERS, type Layer, type Model, type NodeChoice } from "./model";
import type { CameraRig, CameraState } from "./view/camera";

/** Numbers and switches of the model that are part of a view. */
const MARKS = ["throughSurfaces", "pointSize", "normalLength", "smooth", "occlusion", "xray", "slice", "sliceAt", "sliceFlipped", "up"] as const;
type Marks = Pick<Model, (typeof MARKS)[number]>;

export interface ViewState {
  version: 1;
  camera: CameraState;
  layers: Partial<Record<Layer, boolean>>;
  octree: { onlySelected: boolean; level: number };
  nodes: NodeChoice;
  marks: Partial<Marks>;
  field: FieldChoice;
  /** By name. Objects of the same name look the same. */
  objects: Record<string, { visible: boolean; colour: string; opacity: number }>;
  tab: string;
  panels: boolean;
}

/** More objects than these are not stored: browsers keep a few megabytes for each site. */
const MOST_OBJECTS = 2000;

export function viewOf(model: Model, rig: CameraRig, page: Pick<ViewState, "tab" | "panels">): ViewState {
  const objects = model.objects.slice(0, MOST_OBJECTS).filter((object) => !object.visible || object.opacity !== 1 || object.colour !== objectColour(object.index));
  return {
    version: 1, camera: rig.state, layers: { ...model.layers }, octree: { ...model.octree }, nodes: { ...model.nodes }, field: { ...model.field },
    marks: Object.fromEntries(MARKS.map((name) => [name, model[name]])) as Marks,
    objects: Object.fromEntries(objects.map(({ name, visible, colour, opacity }) => [name, { visible, colour, opacity }])),
    ...page,
  };
}

const isRecord = (value: unknown): value is Record<string, unknown> => typeof value === "object" && value !== null && !Array.isArray(value);
const isNumber = (value: unknown): value is number => Number.isFinite(value);
const isPoint = (value: unknown): boolean => Array.isArray(value) && value.length === 3 && value.every(isNumber);

function isCamera(value: unknown): value is CameraState {
  return isRecord(value) && isPoint(value["position"]) && isPoint(value["target"]) && isNumber(value["zoom"]) && value["zoom"] > 0;
}

/** Reads a stored view; null for anything else. Members that are missing keep their value. */
export function readView(text: string | null): Partial<ViewState> | null {
  let value: unknown;
  try {
    value = JSON.parse(text ?? "");
  } catch {
    return null;
  }
  return isRecord(value) && value["version"] === 1 ? (value as Partial<ViewState>) : null;
}

export const cameraOf = (view: Partial<ViewState>): CameraState | null => (isCamera(view.camera) ? view.camera : null);

/** The parts of a choice that are valid. */
function fieldOf(value: unknown): Partial<FieldChoice> {
  if (!isRecord(value)) return {};
  const { key, map, range, arrowLength } = value as unknown as FieldChoice;
  const isRange = range === null || (Array.isArray(range) && range.length === 2 && range.every(isNumber) && range[0] < range[1]);
  return {
    ...((key === null || typeof key === "string") && { key }), ...(MAPS.includes(map) && { map }), ...(isRange && { range }), ...(isNumber(arrowLength) && arrowLength > 0 && { arrowLength }),
  };
}

/** Applies everything but the camera and the panels. */
export function showView(model: Model, view: Partial<ViewState>): void {
  const { layers, octree, nodes, marks, objects, field } = view;
  model.field = { ...model.field, ...fieldOf(field) };
  if (isRecord(layers)) for (const layer of LAYERS) if (typeof layers[layer] === "boolean") model.layers[layer] = layers[layer];
  if (isRecord(octree) && typeof octree.onlySelected === "boolean" && isNumber(octree.level)) model.octree = { onlySelected: octree.onlySelected, level: octree.level };
  if (isRecord(nodes) && isNumber(nodes.level)) {
    const pair = nodes.objects;
    const exists = Array.isArray(pair) && pair.length === 2 && pair.every((object) => object in model.objects);
    model.nodes = { objects: exists ? pair : null, level: nodes.level };
  }
  if (isRecord(marks))
    for (const name of MARKS) if (typeof marks[name] === typeof model[name]) (model as unknown as Record<string, unknown>)[name] = marks[name];
  if (model.up !== "z") model.up = "y";
  if (!["x", "y", "z"].includes(model.slice)) model.slice = "off";
  if (isRecord(objects))
    for (const object of model.objects) {
      const kept = Object.hasOwn(objects, object.name) ? objects[object.name] : undefined;
      if (!isRecord(kept)) continue;
      if (typeof kept.visible === "boolean") object.visible = kept.visible;
      if (typeof kept.colour === "string" && /^#[0-9a-f]{6}$/i.test(kept.colour)) object.colour = kept.colour;
      if (isNumber(kept.opacity)) object.opacity = Math.max(0, Math.min(1, kept.opacity));
    }
}
