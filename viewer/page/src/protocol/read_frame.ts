/** Reads the message of a frame. Everything that it names must exist in the scene. */
import { faultOfField } from "./field_form";
import { EVENT_KINDS, type EventData, type FrameMessage, type FrameText } from "./messages";
import type { SceneCounts } from "./read_scene";
import { fail, isCount, isNumber, isText, need, type Sections } from "./read_sections";

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
  f.pin_frames ??= null;
  f.range ??= [f.step, f.step];
  f.past ??= false;
  f.omitted ??= {};
  f.untested ??= [];
  need(Array.isArray(f.octree_levels) && f.octree_levels.every((level) => level === null || isCount(level)), "octree_levels");
  const isRange = (value: unknown) => Array.isArray(value) && value.length === 2 && value.every(isCount);
  need(isRange(f.range), "range");
  need(f.section === null || isRange(f.section), "section");
  need(f.pin_frames === null || isRange(f.pin_frames), "pin_frames");
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

export function checkEvents(events: EventData, objects: number): void {
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

export function readFrame(sections: Sections, scene: SceneCounts): FrameMessage {
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
