/** The fields of a scene: numbers or vectors of its vertices, triangles or contacts. */
import { columnOf, LIST_NAMES, type ListName } from "./lists";

export interface FieldForm {
  key: string;
  label: string;
  /** A sentence; empty for a field of the user. */
  doc: string;
  unit: string;
  element: "vertex" | "face" | "contact";
  vector: boolean;
  /** The list of frames with the values of contacts, and their column; of vectors, the values are their lengths. */
  list?: ListName;
  column?: string;
}

const isText = (value: unknown): value is string => typeof value === "string";

export function isFieldForm(value: unknown): value is FieldForm {
  if (typeof value !== "object" || value === null) return false;
  const { key, label, doc, unit, element, vector, list, column } = value as FieldForm;
  return [key, label, doc, unit].every(isText) && ["vertex", "face", "contact"].includes(element) && typeof vector === "boolean" &&
    (element === "contact" ? LIST_NAMES.includes(list!) && columnOf(list!, column!) !== undefined : list === undefined);
}

/** A sentence about numbers of a field that do not fit the scene, or null. */
export function faultOfField(
  key: string | null, values: Map<number, Float32Array>, vectors: Map<number, Float32Array>,
  { fields, vertices, faces }: { fields: FieldForm[]; vertices: number[]; faces: number[] },
): string | null {
  const form = fields.find((field) => field.key === key);
  for (const [sent, width] of [[values, 1], [vectors, 3]] as const)
    for (const [object, numbers] of sent) {
      if (!form || form.vector !== (width === 3)) return "it has values of a field that it does not name";
      if (numbers.length !== width * ((form.element === "face" ? faces : vertices)[object] ?? -1)) return `it lacks values of ${form.label} of object ${object}`;
    }
  return null;
}
