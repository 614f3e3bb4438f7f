/** The numbers of the chosen field in the newest frame, and the range that its colours cover. */
import type { Model, ObjectState } from "../model";
import type { FieldForm } from "../protocol/field_form";
import type { FrameMessage } from "../protocol/messages";
import { isDiverging, type MapName } from "./colour_maps";

export interface FieldChoice {
  key: string | null;
  map: MapName;
  /** The lowest and the highest value; null: those of the frame. */
  range: [number, number] | null;
  /** The length of the longest arrow in CSS pixels. */
  arrowLength: number;
}

export const firstChoice = (): FieldChoice => ({ key: null, map: "viridis", range: null, arrowLength: 40 });

export interface FieldData {
  form: FieldForm;
  /** The numbers of vertices or triangles by object, or the lengths of their vectors. */
  values: Map<number, Float32Array>;
  vectors: Map<number, Float32Array>;
  /** Rows of 8 numbers for contacts, which begin with the place. */
  rows: Float32Array;
  /** Of all finite values; not finite when there are none. */
  lowest: number;
  highest: number;
  /** Some vertices or triangles have no value. */
  hasGaps: boolean;
}

export const COLUMNS = 8;

/** What the numbers of a field are, with their unit. */
export const titleOf = ({ label, vector, unit }: FieldForm): string => `${label}${vector ? ", length of the vector" : ""}${unit ? ` (${unit})` : ""}`;

/** The length of each vector. */
function lengthsOf(vectors: Float32Array): Float32Array {
  const lengths = new Float32Array(vectors.length / 3);
  for (let i = 0; i < lengths.length; ++i) lengths[i] = Math.hypot(vectors[3 * i]!, vectors[3 * i + 1]!, vectors[3 * i + 2]!);
  return lengths;
}

function collect(form: FieldForm, frame: FrameMessage, counts: number[]): FieldData {
  const data: FieldData = { form, values: new Map(), vectors: new Map(), rows: new Float32Array(0), lowest: Infinity, highest: -Infinity, hasGaps: false };
  const add = (value: number) => {
    if (!Number.isFinite(value)) return void (data.hasGaps = true);
    if (value < data.lowest) data.lowest = value;
    if (value > data.highest) data.highest = value;
  };
  if (form.element === "contact") {
    const name = form.section!.replace(/_(.)/g, (_, letter: string) => letter.toUpperCase());
    const rows = (frame as unknown as Record<string, unknown>)[name];
    if (rows instanceof Float32Array) data.rows = rows;
    for (let at = form.column!; at < data.rows.length; at += COLUMNS) add(data.rows[at]!);
    return data;
  }
  data.vectors = frame.fieldVectors;
  data.values = form.vector ? new Map([...frame.fieldVectors].map(([object, vectors]) => [object, lengthsOf(vectors)])) : frame.fieldValues;
  for (const numbers of data.values.values()) for (const value of numbers) add(value);
  data.hasGaps ||= counts.some((count, object) => count > 0 && !data.values.has(object));
  return data;
}

const cache = new WeakMap<FrameMessage, FieldData>();

/** Null when no field is chosen, and until the first frame with the chosen one. */
export function readField({ scene, frame, field, objects }: Model): FieldData | null {
  const form = scene?.fields.find(({ key }) => key === field.key);
  if (!form || !frame || frame.text.field !== form.key) return null;
  let data = cache.get(frame);
  if (!data) cache.set(frame, (data = collect(form, frame, objects.map(({ vertices, triangles }) => (form.element === "face" ? triangles : vertices)))));
  return data;
}

/** Whether an object still shows its colour: where the field has no value for it. */
export function showsColour(data: FieldData | null, { index, corners, vertices, triangles }: Pick<ObjectState, "index" | "corners" | "vertices" | "triangles">): boolean {
  if (!data || data.form.element === "contact") return true;
  const isOfFaces = data.form.element === "face";
  const hasRest = isOfFaces && corners.length > 3 * triangles;  // edges and points
  const values = data.values.get(index);
  return hasRest || !values || values.length < (isOfFaces ? triangles : vertices) || !values.every(Number.isFinite);
}

/** The values at both ends of the colour map. Zero is in the middle of a diverging map. */
export function rangeOf({ lowest, highest }: Pick<FieldData, "lowest" | "highest">, { range, map }: Pick<FieldChoice, "range" | "map">): [number, number] {
  if (range) return range;
  if (!(lowest <= highest)) return [0, 0];
  const most = Math.max(Math.abs(lowest), Math.abs(highest));
  return isDiverging(map) ? [-most, most] : [lowest, highest];
}

/** Texts for numbers that are `step` apart. */
export function tickText(value: number, step: number): string {
  const size = Math.max(Math.abs(value), Math.abs(step));
  if (value !== 0 && (size >= 1e6 || size < 1e-3)) return value.toExponential(2).replace(/\.?0+e/, "e").replace("e+", "e");
  const decimals = step > 0 ? Math.max(0, Math.min(12, 1 - Math.floor(Math.log10(step)))) : 4;
  return String(Number(value.toFixed(decimals)));
}
