/** Reads the message of a scene, and keeps the sizes that frames must fit. */
import { isFieldForm, type FieldForm } from "./field_form";
import type { Comparison, SceneMessage, SceneObject, SceneText, Setting } from "./messages";
import { fail, isCount, isNumber, isText, isTexts, isVector, need, type Sections } from "./read_sections";

/** Sizes of the scene, against which frames are validated. */
export interface SceneCounts {
  generation: number;
  vertices: number[];
  triangles: number[];
  statistics: number;
  series: number;
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
    fields: scene.fields,
    faces: scene.objects.map((object) => object.triangles),
  };
}

function isSetting(value: unknown): value is Setting {
  if (typeof value !== "object" || value === null) return false;
  const { key, doc, unit, kind, words } = value as Setting;
  return [key, doc, unit, kind].every(isText) && (kind !== "word" || isTexts(words));
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
  need(Array.isArray(s.fields) && s.fields.every(isFieldForm), "fields");
  s.pin_values ??= [];
  need(Array.isArray(s.pin_values) && s.pin_values.every((value) => isText(value?.key) && isText(value.doc) && isText(value.unit)), "pin_values");
  for (const name of ["can", "statistics", "series", "warnings"] as const) need(isTexts(s[name]), name);
  need(Array.isArray(s.objects), "objects");
  for (const object of s.objects as unknown[]) {
    need(typeof object === "object" && object !== null, "objects");
    const o = object as SceneObject;
    need(isText(o.name) && isCount(o.vertices) && isCount(o.triangles) && isNumber(o.margin), "objects");
  }
  return s;
}

export function readScene(sections: Sections): SceneMessage {
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
