/**
 * Reads the binary messages of the session (docs/protocol.md). It validates all data that the page relies on
 * and returns typed arrays that view the message; nothing is copied.
 */

import { faultOfField, isFieldForm, type FieldForm } from "./field_form";
import { FORMS, KINDS, type Form } from "./sections";

export const NONE = 0xffffffff;
const MAGIC = 0x4c505553;
const VERSION = 1;
const ALIGNMENT = 16;

export class MessageError extends Error {}

export interface SceneObject {
  name: string;
  vertices: number;
  triangles: number;
  static: boolean;
  body: boolean;
  waves?: boolean;
  rigid?: boolean;
  self_collision: boolean;
  /** The object of a program is gone; its number stays. */
  removed?: boolean;
}

export type Vector = [number, number, number];

/** The description of an option, from the library. */
export interface Setting {
  key: string;
  doc: string;
  unit: string;
  kind: "word" | "truth" | "whole" | "number" | "cube";
  /** The values that are allowed, in words; of kinds that are numbers. */
  range?: string;
  words?: string[];
  /** A change restarts the simulation. */
  restarts: boolean;
}

/** The words of the kinds in frames, in the order of their numbers. */
export interface Kinds {
  contact: string[];
  certainty: string[];
  curve: string[];
  /** The elements of a and of b: vertex, edge or face. */
  impact: [string, string][];
}

/** An event that can pause a program: on or off, or the number above which it happens, null for never. */
export interface BreakSetting {
  key: string;
  doc: string;
  unit: string;
  kind: "truth" | "number";
  value: boolean | number | null;
}

/** Why a program is paused. */
export interface Break {
  event: string;
  text: string;
  objects: number[];
  point: Vector | null;
}

/** Two recordings that are shown together, and the frame that differs first; the text is empty when nothing does. */
export interface Comparison {
  names: [string, string];
  /** The first objects are those of the first recording. */
  objects_of_a: number;
  /** Null when only the headers differ. */
  frame: number | null;
  text: string;
}

/** A number that is measured of a pin. */
export interface PinValue {
  key: string;
  doc: string;
  unit: string;
}

export interface SceneText {
  version: string;
  title: string;
  source: "simulation" | "recording" | "program";
  generation: number;
  /** Counts restarts: the steps of one run follow each other. */
  run: number;
  center: Vector;
  bounds: [Vector, Vector];
  border?: [Vector, Vector] | null;
  objects: SceneObject[];
  frames: number | null;
  comparison: Comparison | null;
  time_step: number;
  /** Digits, because numbers of JavaScript are exact only up to 2^53. */
  seed: string;
  contacts: string;
  /** What the command `set` takes. The scene has the value of each, by its key. */
  settings: Setting[];
  kinds: Kinds;
  /** What the command `layers` takes as field. */
  fields: FieldForm[];
  can: string[];
  statistics: string[];
  series: string[];
  /** The numbers in a row of a pin, after step and time. */
  pin_values: PinValue[];
  warnings: string[];
  /** Only of a program. */
  breaks?: BreakSetting[];
  /** The names of objects of which contacts begin; empty for any. */
  break_objects?: string[];
}

export interface FrameText {
  generation: number;
  step: number;
  time: number;
  broad_phase_method?: string;
  playing: boolean;
  speed: number;
  loop?: boolean;
  /** The first and the last step of the section that loops. */
  section: [number, number] | null;
  /** The first and the last step that can be shown. */
  range: [number, number];
  /** A kept step of a simulation or a program, not the newest. */
  past: boolean;
  /** The key of the field whose values the frame has. */
  field: string | null;
  octree_levels: (number | null)[];
  omitted: Record<string, number>;
  /** Kinds of contacts for which there was nothing to test, and why. */
  untested: { kind: string; reason: string }[];
  /** Of a program that an event has paused. */
  break?: Break | null;
}

/** What begins and ends: contacts, collisions of the narrow phase, overlaps of the objects' volumes. */
export const EVENT_KINDS = ["contact", "narrow_phase", "volume"] as const;
export type EventKind = (typeof EVENT_KINDS)[number];
/** For each event the step, or the frame of a recording, and two objects. */
export type EventData = Record<EventKind, { begin: Uint32Array; end: Uint32Array }>;

export interface SceneMessage {
  kind: "scene";
  text: SceneText;
  /** Per object the vertices of triangles, and of edges and points of no triangle. */
  triangles: Map<number, Uint32Array>;
  edges: Map<number, Uint32Array>;
  points: Map<number, Uint32Array>;
}

type FormOfFrame = Extract<(typeof FORMS)[keyof typeof FORMS], { kinds: readonly ["frame"] }>;
type Camel<Name> = Name extends `${infer First}_${infer Rest}` ? `${First}${Capitalize<Camel<Rest> & string>}` : Name;
type ArrayOf<F extends Form> = InstanceType<F["array"]>;
/** The sections of frames as members, with camelCase names; those of each object are maps. */
type FrameSections = {
  [F in FormOfFrame as F["name"] extends `${EventKind}_${"begin" | "end"}` ? never : Camel<F["name"]> & string]:
    F["perObject"] extends true ? Map<number, ArrayOf<F>> : ArrayOf<F>;
};

/** Missing sections are empty. Positions are present for objects that moved. */
export type FrameMessage = {
  kind: "frame"; text: FrameText; events: EventData;
  /** The statistics of each step that the page has not yet, row by row; `statistics` is the last row. */
  steps: Float64Array;
} & FrameSections;

export interface AnswerMessage {
  kind: "answer";
  text: { id: number } & Record<string, unknown>;
}

export interface FailureMessage {
  kind: "failure";
  text: { message: string; fatal: boolean; id?: number; layers?: string[] };
}

export interface SeriesMessage {
  kind: "series";
  values: Float64Array;
  events: EventData;
}

export type Message = SceneMessage | FrameMessage | AnswerMessage | FailureMessage | SeriesMessage;

/** Whether the page reads sections with this tag. */
export const readsTag = (tag: number): boolean => tag in FORMS;

type Data = Uint8Array | Uint32Array | Float32Array | Float64Array;

/** Sizes of the scene, against which frames are validated. */
export interface SceneCounts {
  generation: number;
  vertices: number[];
  triangles: number[];
  statistics: number;
  series: number;
  kinds: Kinds;
  fields: FieldForm[];
  /** Triangles without the edges and points of no triangle. */
  faces: number[];
}

/** The elements of an object that the session numbers: triangles, then edges and points of no triangle. */
const elementsOf = ({ edges, points }: SceneMessage, object: number, triangles: number): number =>
  triangles + (edges.get(object)?.length ?? 0) / 2 + (points.get(object)?.length ?? 0);

export function countsOf(message: SceneMessage): SceneCounts {
  const scene = message.text;
  return {
    generation: scene.generation,
    vertices: scene.objects.map((object) => object.vertices),
    triangles: scene.objects.map((object, i) => elementsOf(message, i, object.triangles)),
    statistics: scene.statistics.length,
    series: scene.series.length,
    kinds: scene.kinds,
    fields: scene.fields,
    faces: scene.objects.map((object) => object.triangles),
  };
}

function fail(what: string): never {
  throw new MessageError(what);
}

class Sections {
  private readonly found = new Map<string, Map<number, Data>>();

  add(form: Form, object: number, data: Data): void {
    let objects = this.found.get(form.name);
    if (!objects) this.found.set(form.name, (objects = new Map()));
    const before = objects.size;
    objects.set(object, data);
    if (objects.size === before) fail(`its section ${form.name} occurs twice`);
  }

  ofFrame(): FrameSections {
    const forms = (Object.values(FORMS) as Form[]).filter(({ kinds }) => kinds[0] === "frame");
    const members = Object.fromEntries(
      forms.map(({ name, array, perObject }) => [
        name.replace(/_(.)/g, (_, letter: string) => letter.toUpperCase()), perObject ? this.each(name) : this.one(name, new array(0)),
      ]),
    );
    return members as unknown as FrameSections;
  }

  one<T extends Data>(name: string, empty: T): T {
    return (this.found.get(name)?.get(NONE) as T | undefined) ?? empty;
  }

  each<T extends Data>(name: string): Map<number, T> {
    return (this.found.get(name) ?? new Map()) as Map<number, T>;
  }

  events(prefix: string): EventData {
    const list = (name: string) => this.one(`${prefix}${name}`, new Uint32Array(0));
    return Object.fromEntries(EVENT_KINDS.map((kind) => [kind, { begin: list(`${kind}_begin`), end: list(`${kind}_end`) }])) as EventData;
  }

  json(): Record<string, unknown> {
    const bytes = this.found.get("text")?.get(NONE) as Uint8Array | undefined;
    if (!bytes) fail("it has no text");
    let value: unknown;
    try {
      value = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
    } catch {
      fail("its text is not JSON");
    }
    if (typeof value !== "object" || value === null || Array.isArray(value)) fail("its text is not a JSON object");
    return value as Record<string, unknown>;
  }
}

function readSections(buffer: ArrayBuffer, kind: string, count: number, seriesWidth: number): Sections {
  const view = new DataView(buffer);
  const sections = new Sections();
  let at = ALIGNMENT;
  for (let i = 0; i < count; ++i) {
    if (at + ALIGNMENT > buffer.byteLength) fail("it ends within its sections");
    const tag = view.getUint32(at, true);
    const object = view.getUint32(at + 4, true);
    const elements = view.getUint32(at + 8, true);
    const bytes = view.getUint32(at + 12, true);
    const start = at + ALIGNMENT;
    at = start + Math.ceil(bytes / ALIGNMENT) * ALIGNMENT;
    if (at > buffer.byteLength) fail("a section reaches past its end");
    const form = (FORMS as Record<number, Form | undefined>)[tag];
    if (!form) continue;  // a section of a later version
    if (!form.kinds.includes(kind)) fail(`a message of kind ${kind} has a section ${form.name}`);
    if (form.perObject !== (object !== NONE)) fail(`its section ${form.name} has a wrong object`);
    const width = form.width || seriesWidth;
    const numbers = elements * width;
    if (numbers * form.array.BYTES_PER_ELEMENT !== bytes) fail(`its section ${form.name} has a wrong length`);
    sections.add(form, object, new form.array(buffer, start, numbers));
  }
  if (at !== buffer.byteLength) fail("it is longer than its sections");
  return sections;
}

const isNumber = (value: unknown): value is number => typeof value === "number" && Number.isFinite(value);
const isCount = (value: unknown): value is number => isNumber(value) && Number.isInteger(value) && value >= 0;
const isText = (value: unknown): value is string => typeof value === "string";
const isVector = (value: unknown): value is Vector =>
  Array.isArray(value) && value.length === 3 && value.every(isNumber);
const isTexts = (value: unknown): value is string[] => Array.isArray(value) && value.every(isText);
const isElement = (value: unknown): boolean => value === "vertex" || value === "edge" || value === "face";

function isKinds(value: unknown): value is Kinds {
  if (typeof value !== "object" || value === null) return false;
  const { contact, certainty, curve, impact } = value as Kinds;
  return [contact, certainty, curve].every(isTexts) && Array.isArray(impact) &&
    impact.every((pair) => Array.isArray(pair) && pair.length === 2 && pair.every(isElement));
}

function isSetting(value: unknown): value is Setting {
  if (typeof value !== "object" || value === null) return false;
  const { key, doc, unit, kind, words } = value as Setting;
  return [key, doc, unit, kind].every(isText) && (kind !== "word" || isTexts(words));
}

function need(ok: boolean, name: string): void {
  if (!ok) fail(`its text has no valid “${name}”`);
}

function isComparison(value: unknown): value is Comparison {
  const { names, objects_of_a: count, frame, text } = value as Comparison;
  return isTexts(names) && names.length === 2 && isCount(count) && (frame === null || isCount(frame)) && isText(text);
}

function sceneText(json: Record<string, unknown>): SceneText {
  const s = json as unknown as SceneText;
  for (const name of ["version", "title", "contacts"] as const) need(isText(s[name]), name);
  need(["simulation", "recording", "program"].includes(s.source), "source");
  need(isCount(s.generation), "generation");
  need(isCount(s.run), "run");
  need(isVector(s.center), "center");
  need(Array.isArray(s.bounds) && s.bounds.length === 2 && s.bounds.every(isVector), "bounds");
  need(!s.border || (s.border.length === 2 && s.border.every(isVector)), "border");
  need(s.frames === null || isCount(s.frames), "frames");
  need((s.frames !== null) === (s.source === "recording"), "frames");
  s.comparison ??= null;
  need(s.comparison === null || isComparison(s.comparison), "comparison");
  need(isNumber(s.time_step), "time_step");
  need(isText(s.seed), "seed");
  need(Array.isArray(s.settings) && s.settings.every(isSetting), "settings");
  need(isKinds(s.kinds), "kinds");
  need(Array.isArray(s.fields) && s.fields.every(isFieldForm), "fields");
  s.pin_values ??= [];
  need(Array.isArray(s.pin_values) && s.pin_values.every((value) => isText(value?.key) && isText(value.doc) && isText(value.unit)), "pin_values");
  for (const name of ["can", "statistics", "series", "warnings"] as const) need(isTexts(s[name]), name);
  need(Array.isArray(s.objects), "objects");
  for (const object of s.objects as unknown[]) {
    need(typeof object === "object" && object !== null, "objects");
    const o = object as SceneObject;
    need(isText(o.name) && isCount(o.vertices) && isCount(o.triangles), "objects");
  }
  return s;
}

function readScene(sections: Sections): SceneMessage {
  const text = sceneText(sections.json());
  const triangles = sections.each<Uint32Array>("triangles");
  for (const [object, corners] of triangles) {
    const of = text.objects[object];
    if (!of) fail("it has triangles of an object that does not exist");
    if (corners.length !== 3 * of.triangles) fail(`it lacks triangles of ${of.name}`);
    for (let i = 0; i < corners.length; ++i)
      if (corners[i]! >= of.vertices) fail(`triangle ${Math.floor(i / 3)} of ${of.name} has a vertex that does not exist`);
  }
  const edges = sections.each<Uint32Array>("edges");
  const points = sections.each<Uint32Array>("points");
  for (const [object, vertices] of [...edges, ...points]) {
    const limit = text.objects[object]?.vertices ?? 0;
    if (vertices.some((vertex) => vertex >= limit)) fail("it has an edge or a point with a vertex that does not exist");
  }
  text.objects.forEach((object, i) => {
    if (object.triangles > 0 && !triangles.has(i)) fail(`it has no triangles of ${object.name}`);
  });
  return { kind: "scene", text, triangles, edges, points };
}

function frameText(json: Record<string, unknown>): FrameText {
  const f = json as unknown as FrameText;
  need(isCount(f.generation), "generation");
  need(isCount(f.step), "step");
  need(isNumber(f.time), "time");
  need(typeof f.playing === "boolean", "playing");
  need(isNumber(f.speed), "speed");
  f.field ??= null;
  need(f.field === null || isText(f.field), "field");
  f.octree_levels ??= [];
  f.section ??= null;
  f.range ??= [f.step, f.step];
  f.past ??= false;
  f.omitted ??= {};
  f.untested ??= [];
  need(Array.isArray(f.octree_levels) && f.octree_levels.every((level) => level === null || isCount(level)), "octree_levels");
  const isRange = (value: unknown) => Array.isArray(value) && value.length === 2 && value.every(isCount);
  need(isRange(f.range), "range");
  need(f.section === null || isRange(f.section), "section");
  need(typeof f.omitted === "object" && Object.values(f.omitted).every(isCount), "omitted");
  need(Array.isArray(f.untested) && f.untested.every((entry) => isText(entry?.kind) && isText(entry?.reason)), "untested");
  return f;
}

/** Every `stride` numbers contain an object and a number below its limit, at the two offsets in `at`. */
function checkIds(name: string, data: Uint32Array, stride: number, at: [number, number], limits: number[]): void {
  for (let i = 0; i < data.length; i += stride)
    for (const place of at) {
      const limit = limits[data[i + place]!];
      if (limit === undefined || data[i + place + 1]! >= limit) fail(`its section ${name} names something that does not exist`);
    }
}

function checkPairs(name: string, data: Uint32Array, stride: number, at: number, objects: number): void {
  for (let i = 0; i < data.length; i += stride)
    if (data[i + at]! >= objects || data[i + at + 1]! >= objects) fail(`its section ${name} names an object that does not exist`);
}

function checkEvents(events: EventData, objects: number): void {
  for (const kind of EVENT_KINDS)
    for (const side of ["begin", "end"] as const) checkPairs(`${kind}_${side}`, events[kind][side], 3, 1, objects);
}

function checkContacts(contacts: Uint32Array, points: number, kinds: number): void {
  for (let i = 0; i < contacts.length; i += 8) {
    if (contacts[i + 4]! >= kinds) fail("a contact has an unknown kind");
    if (contacts[i + 5]! + contacts[i + 6]! > points) fail("a contact has points that do not exist");
  }
}

function checkImpacts(impacts: Uint32Array, scene: SceneCounts): void {
  for (let i = 0; i < impacts.length; i += 8) {
    const kinds = scene.kinds.impact[impacts[i + 6]!];
    if (!kinds || impacts[i + 7]! >= scene.kinds.certainty.length) fail("an impact has an unknown kind");
    kinds.forEach((kind, side) => {
      const limit = (kind === "face" ? scene.triangles : scene.vertices)[impacts[i + 3 * side]!];
      const first = impacts[i + 3 * side + 1]!;
      const second = impacts[i + 3 * side + 2]!;
      if (limit === undefined || first >= limit || (kind === "edge" && second >= limit)) fail("an impact names an element that does not exist");
    });
  }
}

function checkCurves({ curves, curvePoints, enclosedVertices }: FrameMessage, scene: SceneCounts): void {
  if (curvePoints.length !== curves.length) fail("the numbers of curves and of their points differ");
  for (let i = 0; i < curves.length; i += 8) {
    if (curves[i + 2]! >= scene.kinds.curve.length) fail("a curve has an unknown kind");
    let at = curves[i + 4]!;
    for (const side of [0, 1]) {
      const limit = scene.vertices[curves[i + side]!];
      if (limit === undefined) fail("a curve names an object that does not exist");
      const vertices = enclosedVertices.subarray(at, (at += curves[i + 5 + side]!));
      if (at > enclosedVertices.length || vertices.some((vertex) => vertex >= limit)) fail("a curve encloses a vertex that does not exist");
    }
  }
}

function readFrame(sections: Sections, scene: SceneCounts): FrameMessage {
  const text = frameText(sections.json());
  const rows = sections.ofFrame();
  const steps = rows.statistics;
  const frame: FrameMessage = {
    kind: "frame", text, events: sections.events(""), ...rows, steps, statistics: steps.subarray(Math.max(0, steps.length - scene.statistics)),
  };
  if (text.generation !== scene.generation) return frame;  // belongs to an earlier scene and will be ignored
  for (const [object, positions] of frame.positions)
    if (positions.length !== 3 * (scene.vertices[object] ?? -1)) fail(`it lacks positions of object ${object}`);
  for (const [object, vertices] of frame.collidingVertices) {
    const limit = scene.vertices[object] ?? 0;
    if (vertices.some((vertex) => vertex >= limit)) fail("its section colliding_vertices names a vertex that does not exist");
  }
  const { octreeBoxes, octreeSpheres, octreeEdges, collidingBoxes, collidingSpheres, collidingEdges } = frame;
  for (const shapes of [octreeBoxes, octreeSpheres, octreeEdges, collidingBoxes, collidingSpheres, collidingEdges])
    for (const object of shapes.keys()) if (object >= scene.vertices.length) fail("it has an octree of an object that does not exist");
  checkPairs("object_pairs", frame.objectPairs, 2, 0, scene.vertices.length);
  checkEvents(frame.events, scene.vertices.length);
  checkIds("contacts", frame.contacts, 8, [0, 2], scene.triangles);
  checkContacts(frame.contacts, frame.contactPoints.length / 8, scene.kinds.contact.length);
  checkIds("candidates", frame.candidates, 4, [0, 2], scene.triangles);
  checkImpacts(frame.impacts, scene);
  if (frame.impactPoints.length !== frame.impacts.length) fail("the numbers of impacts and of their points differ");
  if (frame.proximityPairs.some((object) => object >= scene.vertices.length)) fail("a proximity pair names an object that does not exist");
  if (frame.proximityPoints.length !== 4 * frame.proximityPairs.length) fail("the numbers of proximity pairs and of their points differ");
  checkIds("penetrations", frame.penetrations, 4, [2, 2], scene.triangles);
  checkIds("penetrations", frame.penetrations, 4, [0, 0], scene.vertices);
  if (frame.penetrationPoints.length !== 2 * frame.penetrations.length) fail("the numbers of penetrations and of their points differ");
  checkCurves(frame, scene);
  const fault = faultOfField(text.field, frame.fieldValues, frame.fieldVectors, scene);
  if (fault) fail(fault);
  if (scene.statistics === 0 ? steps.length !== 0 : steps.length % scene.statistics !== 0) fail("its statistics are not those of the scene");
  return frame;
}

function readSeries(sections: Sections, scene: SceneCounts): SeriesMessage {
  const events = sections.events("series_");
  checkEvents(events, scene.vertices.length);
  return { kind: "series", values: sections.one("series", new Float64Array(0)), events };
}

function readAnswer(sections: Sections): AnswerMessage {
  const text = sections.json() as AnswerMessage["text"];
  need(isNumber(text.id), "id");
  return { kind: "answer", text };
}

function readFailure(sections: Sections): FailureMessage {
  const text = sections.json() as FailureMessage["text"];
  need(isText(text.message), "message");
  need(typeof text.fatal === "boolean", "fatal");
  need(text.layers === undefined || isTexts(text.layers), "layers");
  return { kind: "failure", text };
}

const NO_SCENE: SceneCounts = {
  generation: -1, vertices: [], triangles: [], statistics: 0, series: 0, kinds: { contact: [], certainty: [], curve: [], impact: [] },
  fields: [], faces: [],
};

/**
 * Reads one message. `scene` has the sizes from the last scene message, or is null before the first one.
 * Throws `MessageError` with one sentence when the data is not a message of this version.
 */
export function readMessage(buffer: ArrayBuffer, scene: SceneCounts | null): Message {
  if (buffer.byteLength < ALIGNMENT) fail("it is shorter than a header");
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) fail("it does not begin like a message of Supple");
  const version = view.getUint16(4, true);
  if (version !== VERSION) fail(`it has version ${version}, and this page reads version ${VERSION}`);
  if (view.getUint32(8, true) !== buffer.byteLength || buffer.byteLength % ALIGNMENT !== 0) fail("its length differs from its header");
  const kind = KINDS[view.getUint16(6, true)];
  if (!kind) fail("it has an unknown kind");
  const counts = scene ?? NO_SCENE;
  if ((kind === "frame" || kind === "series") && !scene) fail(`a ${kind} came before the scene`);
  const sections = readSections(buffer, kind, view.getUint32(12, true), counts.series);
  switch (kind) {
    case "scene": return readScene(sections);
    case "frame": return readFrame(sections, counts);
    case "answer": return readAnswer(sections);
    case "failure": return readFailure(sections);
    case "series": return readSeries(sections, counts);
  }
}
