// `make docs` writes this file from viewer/session/messages/sections.hpp.

export const ARRAYS = { uint8: Uint8Array, uint32: Uint32Array, float32: Float32Array, float64: Float64Array };
export type Scalar = keyof typeof ARRAYS;

export interface Form {
  name: string;
  scalar: Scalar;
  /** Numbers per element; 0 when something else determines it. */
  width: number;
  is_of_object: boolean;
  kinds: readonly string[];
}

export const KINDS = ["", "scene", "frame", "answer", "failure", "series"] as const;

export const FORMS = {
  1: {"name": "text", "scalar": "uint8", "width": 1, "is_of_object": false, "kinds": ["scene", "frame", "answer", "failure"]},
  16: {"name": "triangles", "scalar": "uint32", "width": 3, "is_of_object": true, "kinds": ["scene"]},
  17: {"name": "edges", "scalar": "uint32", "width": 2, "is_of_object": true, "kinds": ["scene"]},
  18: {"name": "points", "scalar": "uint32", "width": 1, "is_of_object": true, "kinds": ["scene"]},
  32: {"name": "positions", "scalar": "float32", "width": 3, "is_of_object": true, "kinds": ["frame"]},
  33: {"name": "column", "scalar": "uint8", "width": 0, "is_of_object": true, "kinds": ["frame"]},
  38: {"name": "candidates", "scalar": "uint32", "width": 4, "is_of_object": false, "kinds": ["frame"]},
  39: {"name": "scene_regions", "scalar": "float32", "width": 8, "is_of_object": false, "kinds": ["frame"]},
  40: {"name": "octree_boxes", "scalar": "float32", "width": 8, "is_of_object": true, "kinds": ["frame"]},
  41: {"name": "octree_spheres", "scalar": "float32", "width": 8, "is_of_object": true, "kinds": ["frame"]},
  42: {"name": "colliding_vertices", "scalar": "uint32", "width": 1, "is_of_object": true, "kinds": ["frame"]},
  43: {"name": "statistics", "scalar": "float64", "width": 1, "is_of_object": false, "kinds": ["frame"]},
  44: {"name": "contact_begin", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["frame"]},
  45: {"name": "contact_end", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["frame"]},
  46: {"name": "narrow_phase_begin", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["frame"]},
  47: {"name": "narrow_phase_end", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["frame"]},
  48: {"name": "volume_begin", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["frame"]},
  49: {"name": "volume_end", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["frame"]},
  50: {"name": "colliding_boxes", "scalar": "float32", "width": 8, "is_of_object": true, "kinds": ["frame"]},
  51: {"name": "colliding_spheres", "scalar": "float32", "width": 8, "is_of_object": true, "kinds": ["frame"]},
  52: {"name": "octree_edges", "scalar": "float32", "width": 8, "is_of_object": true, "kinds": ["frame"]},
  53: {"name": "colliding_edges", "scalar": "float32", "width": 8, "is_of_object": true, "kinds": ["frame"]},
  61: {"name": "field_values", "scalar": "float32", "width": 1, "is_of_object": true, "kinds": ["frame"]},
  62: {"name": "field_vectors", "scalar": "float32", "width": 3, "is_of_object": true, "kinds": ["frame"]},
  63: {"name": "pin_rows", "scalar": "float64", "width": 13, "is_of_object": true, "kinds": ["frame"]},
  64: {"name": "series", "scalar": "float64", "width": 0, "is_of_object": false, "kinds": ["series"]},
  65: {"name": "series_contact_begin", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["series"]},
  66: {"name": "series_contact_end", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["series"]},
  67: {"name": "series_narrow_phase_begin", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["series"]},
  68: {"name": "series_narrow_phase_end", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["series"]},
  69: {"name": "series_volume_begin", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["series"]},
  70: {"name": "series_volume_end", "scalar": "uint32", "width": 3, "is_of_object": false, "kinds": ["series"]},
} as const satisfies Record<number, Form>;
