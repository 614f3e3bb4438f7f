/** Reads the message of a frame. Everything that it names must exist in the scene. */
import { eachElement, SIDES } from "../records";
import { faultOfField } from "./field_form";
import { formOf, LIST_NAMES, type Rows } from "./lists";
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

/** Every two numbers are an object and an element of it. */
function checkCandidates(data: Uint32Array, limits: number[]): void {
  for (let i = 0; i < data.length; i += 2)
    if (!(data[i + 1]! < (limits[data[i]!] ?? 0))) fail("its section candidates names something that does not exist");
}

export function checkEvents(events: EventData, objects: number): void {
  for (const kind of EVENT_KINDS)
    for (const side of ["begin", "end"] as const)
      if (events[kind][side].some((object, i) => i % 3 > 0 && object >= objects)) fail(`its section ${kind}_${side} names an object that does not exist`);
}

/** Objects, words and elements exist. Rows of other lists are used as far as there are any. */
function checkRows(rows: Rows, scene: SceneCounts): void {
  for (const { name, names, words } of formOf(rows.list).columns) {
    const limit = names === "object" ? scene.vertices.length : words.length || Infinity;
    if (rows.columns[name]!.some((value: number) => value >= limit)) fail(`its list ${rows.list} has an unknown ${name}`);
  }
  for (const side of SIDES)
    eachElement(rows, side, (object, kind, first, second) => {
      const limit = (kind === "face" ? scene.triangles : scene.vertices)[object]!;
      if (first >= limit || second >= limit) fail(`its list ${rows.list} names an element that does not exist`);
    });
}

export function readFrame(sections: Sections, scene: SceneCounts): FrameMessage {
  const text = frameText(sections.json());
  const rows = sections.ofFrame();
  const steps = rows.statistics;
  const frame: FrameMessage = {
    kind: "frame", text, events: sections.events(""), lists: sections.lists(), ...rows, steps, statistics: steps.subarray(Math.max(0, steps.length - scene.statistics)),
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
  checkEvents(frame.events, scene.vertices.length);
  checkCandidates(frame.candidates, scene.triangles);
  for (const list of LIST_NAMES) checkRows(frame.lists[list], scene);
  const fault = faultOfField(text.field, frame.fieldValues, frame.fieldVectors, scene);
  if (fault) fail(fault);
  if (scene.statistics === 0 ? steps.length !== 0 : steps.length % scene.statistics !== 0) fail("its statistics are not those of the scene");
  return frame;
}
