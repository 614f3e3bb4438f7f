// `make docs` writes this file from viewer/session/messages/sections.hpp.

export interface Form {
  name: string;
  array: Uint8ArrayConstructor | Uint32ArrayConstructor | Float32ArrayConstructor | Float64ArrayConstructor;
  /** Numbers per element; 0 when the scene determines it. */
  width: number;
  kinds: readonly string[];
  perObject: boolean;
}

export const KINDS = ["", "scene", "frame", "answer", "failure", "series"] as const;

export const FORMS = {
  1: { name: "text", array: Uint8Array, width: 1, kinds: ["scene", "frame", "answer", "failure"], perObject: false },
  16: { name: "triangles", array: Uint32Array, width: 3, kinds: ["scene"], perObject: true },
  17: { name: "edges", array: Uint32Array, width: 2, kinds: ["scene"], perObject: true },
  18: { name: "points", array: Uint32Array, width: 1, kinds: ["scene"], perObject: true },
  32: { name: "positions", array: Float32Array, width: 3, kinds: ["frame"], perObject: true },
  33: { name: "object_pairs", array: Uint32Array, width: 2, kinds: ["frame"], perObject: false },
  34: { name: "contacts", array: Uint32Array, width: 8, kinds: ["frame"], perObject: false },
  35: { name: "contact_points", array: Float32Array, width: 8, kinds: ["frame"], perObject: false },
  36: { name: "impacts", array: Uint32Array, width: 8, kinds: ["frame"], perObject: false },
  37: { name: "impact_points", array: Float32Array, width: 8, kinds: ["frame"], perObject: false },
  38: { name: "candidates", array: Uint32Array, width: 4, kinds: ["frame"], perObject: false },
  39: { name: "scene_regions", array: Float32Array, width: 8, kinds: ["frame"], perObject: false },
  40: { name: "octree_boxes", array: Float32Array, width: 8, kinds: ["frame"], perObject: true },
  41: { name: "octree_spheres", array: Float32Array, width: 8, kinds: ["frame"], perObject: true },
  42: { name: "colliding_vertices", array: Uint32Array, width: 1, kinds: ["frame"], perObject: true },
  43: { name: "statistics", array: Float64Array, width: 1, kinds: ["frame"], perObject: false },
  44: { name: "contact_begin", array: Uint32Array, width: 3, kinds: ["frame"], perObject: false },
  45: { name: "contact_end", array: Uint32Array, width: 3, kinds: ["frame"], perObject: false },
  46: { name: "narrow_phase_begin", array: Uint32Array, width: 3, kinds: ["frame"], perObject: false },
  47: { name: "narrow_phase_end", array: Uint32Array, width: 3, kinds: ["frame"], perObject: false },
  48: { name: "volume_begin", array: Uint32Array, width: 3, kinds: ["frame"], perObject: false },
  49: { name: "volume_end", array: Uint32Array, width: 3, kinds: ["frame"], perObject: false },
  50: { name: "colliding_boxes", array: Float32Array, width: 8, kinds: ["frame"], perObject: true },
  51: { name: "colliding_spheres", array: Float32Array, width: 8, kinds: ["frame"], perObject: true },
  52: { name: "octree_edges", array: Float32Array, width: 8, kinds: ["frame"], perObject: true },
  53: { name: "colliding_edges", array: Float32Array, width: 8, kinds: ["frame"], perObject: true },
  54: { name: "proximity_pairs", array: Uint32Array, width: 2, kinds: ["frame"], perObject: false },
  55: { name: "proximity_points", array: Float32Array, width: 8, kinds: ["frame"], perObject: false },
  56: { name: "penetrations", array: Uint32Array, width: 4, kinds: ["frame"], perObject: false },
  57: { name: "penetration_points", array: Float32Array, width: 8, kinds: ["frame"], perObject: false },
  58: { name: "curves", array: Uint32Array, width: 8, kinds: ["frame"], perObject: false },
  59: { name: "curve_points", array: Float32Array, width: 8, kinds: ["frame"], perObject: false },
  60: { name: "enclosed_vertices", array: Uint32Array, width: 1, kinds: ["frame"], perObject: false },
  61: { name: "field_values", array: Float32Array, width: 1, kinds: ["frame"], perObject: true },
  62: { name: "field_vectors", array: Float32Array, width: 3, kinds: ["frame"], perObject: true },
  63: { name: "pin_rows", array: Float64Array, width: 13, kinds: ["frame"], perObject: true },
  64: { name: "series", array: Float64Array, width: 0, kinds: ["series"], perObject: false },
  65: { name: "series_contact_begin", array: Uint32Array, width: 3, kinds: ["series"], perObject: false },
  66: { name: "series_contact_end", array: Uint32Array, width: 3, kinds: ["series"], perObject: false },
  67: { name: "series_narrow_phase_begin", array: Uint32Array, width: 3, kinds: ["series"], perObject: false },
  68: { name: "series_narrow_phase_end", array: Uint32Array, width: 3, kinds: ["series"], perObject: false },
  69: { name: "series_volume_begin", array: Uint32Array, width: 3, kinds: ["series"], perObject: false },
  70: { name: "series_volume_end", array: Uint32Array, width: 3, kinds: ["series"], perObject: false },
} as const satisfies Record<number, Form>;
