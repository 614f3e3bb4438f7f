/**
 * What the user chose: camera, layers, marks, objects and panels, as one object that JSON can hold. A view file
 * has it, and the browser keeps it for each scene, so that it survives a reload and a restart of the program.
 * `protocol/view_members.ts` has the ranges of all members; docs/viewer.md describes them.
 */
import type { MapName } from "./fields/colour_maps";
import { LAYERS, MOST_VIEWS, usualLook, type Layer, type Model, type NodeChoice, type SliceChoice } from "./model";
import type { StoredPin } from "./pins";
import type { CameraRig, CameraState } from "./view/camera";
import { PANE_NAMES, type StoredPanes } from "./view/panes";

/** Members of the model that are part of a view, by their names in a view. */
const MARKS = {
  through_surfaces: "throughSurfaces", point_size: "pointSize", normal_length: "normalLength", smooth: "smooth", occlusion: "occlusion",
  xray: "xray", up: "up", hover: "hover",
} as const satisfies Record<string, keyof Model>;
type Marks = { [Name in keyof typeof MARKS]: Model[(typeof MARKS)[Name]] } & { slice: SliceChoice["axis"]; slice_at: number; slice_flipped: boolean };
/** What the views besides the first have of their own, by their names. */
interface StoredLooks {
  slices: Record<string, Partial<SliceChoice>>;
  /** The names of objects that are not visible. */
  hidden: Record<string, Record<string, boolean>>;
}

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
  views: Partial<StoredPanes & StoredLooks>;
  pins: Record<string, StoredPin>;
}

interface ObjectLook {
  visible: boolean;
  colour: string;
  opacity: number;
}

/** More objects than these are not stored by the browser, which keeps a few megabytes for each site. */
export const MOST_STORED = 2000;

/** The views besides the first that exist: those with a camera. */
function looksOf(model: Model, cameras: StoredPanes["cameras"], most: number): StoredLooks {
  const views = PANE_NAMES.map((name, view) => ({ name, view })).filter(({ name }) => name in cameras);
  const hiddenIn = (view: number) => model.objects.slice(0, most).filter(({ visibleIn }) => !visibleIn[view]).map(({ name }) => [name, true]);
  return {
    slices: Object.fromEntries(views.map(({ name, view }) => [name, { ...model.slices[view]! }])),
    hidden: Object.fromEntries(views.map(({ name, view }) => [name, Object.fromEntries(hiddenIn(view))])),
  };
}

/** Applies what the views besides the first have. In a file without it, all views have the slice and the objects of the first. */
export function showLooks(model: Model, { marks, objects, views }: Partial<ViewState>): void {
  if (!marks && !objects && !views) return;
  for (let view = 1; view < MOST_VIEWS; ++view) {
    const name = PANE_NAMES[view]!;
    model.copyView(0, view);
    Object.assign(model.slices[view]!, views?.slices?.[name]);
    const names = views?.hidden?.[name];
    if (names) for (const object of model.objects) object.visibleIn[view] = !(Object.hasOwn(names, object.name) && names[object.name]);
  }
}

export function viewOf(model: Model, rig: CameraRig, page: Pick<ViewState, "tab" | "panels" | "pins"> & { views: StoredPanes }, most = Infinity): ViewState {
  const [slice] = model.slices;
  const objects = model.objects.slice(0, most).filter(({ index, visibleIn, opacity, colour }) => {
    const usual = usualLook(model.scene!, index);
    return !visibleIn[0] || opacity !== usual.opacity || colour !== usual.colour;
  });
  return {
    version: 1, camera: rig.state, layers: { ...model.layers },
    octree: { only_selected: model.octree.onlySelected, level: model.octree.level }, nodes: { ...model.nodes },
    field: { key: model.field.key, map: model.field.map, range: model.field.range, arrow_length: model.field.arrowLength },
    marks: { ...Object.fromEntries(Object.entries(MARKS).map(([name, member]) => [name, model[member]])), slice: slice!.axis, slice_at: slice!.at, slice_flipped: slice!.flipped } as Marks,
    objects: Object.fromEntries(objects.map(({ name, visibleIn, colour, opacity }) => [name, { visible: visibleIn[0]!, colour, opacity }])),
    filter: model.filter, ...page, views: { ...page.views, ...looksOf(model, page.views.cameras, most) },
  };
}

/** Applies a checked view, except its camera, step, panels and other views. Members that are missing keep their value. The first view is active. */
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
  model.slices[0] = { axis: marks?.slice ?? model.slice.axis, at: marks?.slice_at ?? model.slice.at, flipped: marks?.slice_flipped ?? model.slice.flipped };
  model.filter = filter ?? model.filter;
}

/** Without a position and a target, the camera still frames the scene. */
export function applyCamera(rig: CameraRig, camera: Partial<CameraState>): void {
  if (camera.position || camera.target || camera.zoom !== undefined) rig.state = { ...rig.state, ...camera };
  else if (camera.orthographic !== undefined) rig.setOrthographic(camera.orthographic);
}
