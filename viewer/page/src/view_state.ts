/**
 * What the user chose: camera, layers, marks, objects and panels, as one object that JSON can hold. A view file
 * has it, and the browser keeps it for each scene, so that it survives a reload and a restart of the program.
 * `protocol/view_members.ts` has the ranges of all members; docs/view_file.md describes them.
 */
import type { MapName } from "./fields/colour_maps";
import { LAYERS, usualLook, type Layer, type Model, type NodeChoice } from "./model";
import type { StoredPin } from "./pins";
import type { CameraRig, CameraState } from "./view/camera";
import type { StoredPanes } from "./view/panes";

/** Members of the model that are part of a view, by their names in a view. */
const MARKS = {
  through_surfaces: "throughSurfaces", point_size: "pointSize", normal_length: "normalLength", smooth: "smooth", occlusion: "occlusion",
  xray: "xray", slice: "slice", slice_at: "sliceAt", slice_flipped: "sliceFlipped", up: "up", hover: "hover",
} as const satisfies Record<string, keyof Model>;
type Marks = { [Name in keyof typeof MARKS]: Model[(typeof MARKS)[Name]] };

export interface ViewState {
  version: 1;
  /** Of a link to a moment. */
  step?: number;
  camera: Partial<CameraState>;
  layers: Partial<Record<Layer, boolean>>;
  octree: { only_selected: boolean; level: number };
  nodes: NodeChoice;
  marks: Partial<Marks>;
  field: { key?: string | null; map?: MapName; range?: [number, number] | null; arrow_length?: number };
  /** By name. Objects of the same name look the same. */
  objects: Record<string, Partial<ObjectLook>>;
  filter: string;
  tab: string;
  panels: boolean;
  views: Partial<StoredPanes>;
  pins: Record<string, StoredPin>;
}

interface ObjectLook {
  visible: boolean;
  colour: string;
  opacity: number;
}

/** More objects than these are not stored by the browser, which keeps a few megabytes for each site. */
export const MOST_STORED = 2000;

export function viewOf(model: Model, rig: CameraRig, page: Pick<ViewState, "tab" | "panels" | "views" | "pins">, most = Infinity): ViewState {
  const objects = model.objects.slice(0, most).filter(({ index, visible, opacity, colour }) => {
    const usual = usualLook(model.scene!, index);
    return !visible || opacity !== usual.opacity || colour !== usual.colour;
  });
  return {
    version: 1, camera: rig.state, layers: { ...model.layers },
    octree: { only_selected: model.octree.onlySelected, level: model.octree.level }, nodes: { ...model.nodes },
    field: { key: model.field.key, map: model.field.map, range: model.field.range, arrow_length: model.field.arrowLength },
    marks: Object.fromEntries(Object.entries(MARKS).map(([name, member]) => [name, model[member]])) as Marks,
    objects: Object.fromEntries(objects.map(({ name, visible, colour, opacity }) => [name, { visible, colour, opacity }])),
    filter: model.filter, ...page,
  };
}

/** Applies a checked view, except its camera, step and panels. Members that are missing keep their value. */
export function showView(model: Model, view: Partial<ViewState>): void {
  const { layers, octree, nodes, marks, field, objects, filter } = view;
  if (field) model.field = { key: field.key === undefined ? model.field.key : field.key, map: field.map ?? model.field.map, range: field.range === undefined ? model.field.range : field.range, arrowLength: field.arrow_length ?? model.field.arrowLength };
  for (const layer of LAYERS) model.layers[layer] = layers?.[layer] ?? model.layers[layer];
  model.octree = { onlySelected: octree?.only_selected ?? model.octree.onlySelected, level: octree?.level ?? model.octree.level };
  if (nodes) {
    const pair = nodes.objects;
    model.nodes = { objects: pair?.every((object) => object in model.objects) ? pair : null, level: nodes.level ?? model.nodes.level };
  }
  for (const [name, member] of Object.entries(MARKS)) {
    const value = marks?.[name as keyof Marks];
    if (value !== undefined) (model as unknown as Record<string, unknown>)[member] = value;
  }
  if (objects)
    for (const object of model.objects) {
      const look = Object.hasOwn(objects, object.name) ? objects[object.name]! : {};
      Object.assign(object, usualLook(model.scene!, object.index), look);
    }
  model.filter = filter ?? model.filter;
}

/** Without a position and a target, the camera still frames the scene. */
export function applyCamera(rig: CameraRig, camera: Partial<CameraState>): void {
  if (camera.position || camera.target || camera.zoom !== undefined) rig.state = { ...rig.state, ...camera };
  else if (camera.orthographic !== undefined) rig.setOrthographic(camera.orthographic);
}
