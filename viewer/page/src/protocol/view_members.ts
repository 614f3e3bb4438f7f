// `make docs` writes this file from viewer/view_file/view_members.hpp.

export interface ViewMember {
  path: string;
  kind: "number" | "whole" | "truth" | "word" | "colour" | "text" | "key" | "point" | "interval" | "objects";
  /** What a value must be, in words. */
  range: string;
  /** Of numbers; `above` excludes the lowest number. */
  low: number;
  high: number;
  above: boolean;
  words: readonly string[];
}

export const VIEW_MEMBERS: readonly ViewMember[] = [
  { path: "version", kind: "whole", range: "1", low: 1, high: 1, above: false, words: [] },
  { path: "step", kind: "whole", range: "a whole number from 0 to 9000000000000000", low: 0, high: 9000000000000000, above: false, words: [] },
  { path: "camera.position", kind: "point", range: "three finite numbers", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "camera.target", kind: "point", range: "three finite numbers", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "camera.zoom", kind: "number", range: "a finite number above 0", low: 0, high: Infinity, above: true, words: [] },
  { path: "camera.orthographic", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.surface", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.wireframe", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.regions", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.octree", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.nodes", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.pairs", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.candidates", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.triangles", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.points", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.normals", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.segments", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.proximity", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.depths", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.curves", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "layers.vertices", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "octree.only_selected", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "octree.level", kind: "whole", range: "a whole number from -1 to 32", low: -1, high: 32, above: false, words: [] },
  { path: "nodes.objects", kind: "objects", range: "null, or two objects by their numbers from 0", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "nodes.level", kind: "whole", range: "a whole number from -2 to 32", low: -2, high: 32, above: false, words: [] },
  { path: "marks.through_surfaces", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "marks.point_size", kind: "number", range: "a number from 1 to 100", low: 1, high: 100, above: false, words: [] },
  { path: "marks.normal_length", kind: "number", range: "a number from 1 to 1000", low: 1, high: 1000, above: false, words: [] },
  { path: "marks.smooth", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "marks.occlusion", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "marks.xray", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "marks.slice", kind: "word", range: "one of off, x, y, z", low: -Infinity, high: Infinity, above: false, words: ["off", "x", "y", "z"] },
  { path: "marks.slice_at", kind: "number", range: "a number from 0 to 1", low: 0, high: 1, above: false, words: [] },
  { path: "marks.slice_flipped", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "marks.up", kind: "word", range: "one of y, z", low: -Infinity, high: Infinity, above: false, words: ["y", "z"] },
  { path: "field.key", kind: "key", range: "null, or a text", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "field.map", kind: "word", range: "one of viridis, cividis, magma, inferno, coolwarm", low: -Infinity, high: Infinity, above: false, words: ["viridis", "cividis", "magma", "inferno", "coolwarm"] },
  { path: "field.range", kind: "interval", range: "null, or two numbers of which the second is larger", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "field.arrow_length", kind: "number", range: "a finite number above 0", low: 0, high: Infinity, above: true, words: [] },
  { path: "marks.hover", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "objects.*.visible", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "objects.*.colour", kind: "colour", range: "a colour such as #8ecae6", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "objects.*.opacity", kind: "number", range: "a number from 0 to 1", low: 0, high: 1, above: false, words: [] },
  { path: "filter", kind: "text", range: "a text", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "tab", kind: "word", range: "one of Inspect, Contacts, Curves, Pins, Plots, Settings", low: -Infinity, high: Infinity, above: false, words: ["Inspect", "Contacts", "Curves", "Pins", "Plots", "Settings"] },
  { path: "panels", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "views.layout", kind: "word", range: "one of one, two, four", low: -Infinity, high: Infinity, above: false, words: ["one", "two", "four"] },
  { path: "views.cameras.*.position", kind: "point", range: "three finite numbers", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "views.cameras.*.target", kind: "point", range: "three finite numbers", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "views.cameras.*.zoom", kind: "number", range: "a finite number above 0", low: 0, high: Infinity, above: true, words: [] },
  { path: "views.cameras.*.orthographic", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "views.slices.*.axis", kind: "word", range: "one of off, x, y, z", low: -Infinity, high: Infinity, above: false, words: ["off", "x", "y", "z"] },
  { path: "views.slices.*.at", kind: "number", range: "a number from 0 to 1", low: 0, high: 1, above: false, words: [] },
  { path: "views.slices.*.flipped", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "views.hidden.*.*", kind: "truth", range: "true or false", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "pins.*.a", kind: "text", range: "a text", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "pins.*.b", kind: "text", range: "a text", low: -Infinity, high: Infinity, above: false, words: [] },
  { path: "pins.*.contact", kind: "text", range: "a text", low: -Infinity, high: Infinity, above: false, words: [] },
];
