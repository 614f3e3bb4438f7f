/** The layers with their labels, and how each list of a frame is drawn: a list that has no style has contact points. */
import { MARKS } from "../colours";
import type { Layer } from "../model";
import type { ListName } from "../protocol/lists";
import type { FrameMessage } from "../protocol/messages";
import { ANSWERS } from "../records";

export interface Style {
  layer: Layer;
  /** What draws the rows, in `Layers`. */
  draws: "contact" | "gaps" | "depths" | "curves";
  /** What a row is, where words of its columns do not say it: in a table, and in full. */
  words?: [string, string];
  /** Between the names of the objects. */
  joins?: string;
  /** The elements of a row are not shown. */
  hidesElements?: boolean;
}

const STYLES: Partial<Record<ListName, Style>> = {
  proximity_pairs: { layer: "proximity", draws: "gaps", words: ["near", "near"], hidesElements: true },
  penetrations: { layer: "depths", draws: "depths", words: ["inside", "vertex inside"], joins: "in" },
  curves: { layer: "curves", draws: "curves" },
};
export const styleOf = (list: ListName): Style => STYLES[list] ?? { layer: "points", draws: "contact" };
/** The lists whose rows are drawn. */
export const DRAWN = [...new Set([...ANSWERS, ...(Object.keys(STYLES) as ListName[])])];
export const drawnAs = (draws: Style["draws"]): ListName[] => DRAWN.filter((list) => styleOf(list).draws === draws);

export interface LayerRow {
  layer: Layer;
  label: string;
  key: string;
  colour: string;
  hint: string;
  /** The lists that fill the layer. */
  lists?: ListName[];
  /** Only contacts of these kinds do; by default those that the lists answer. */
  kinds?: string[];
  /** Whether a frame has content for the layer. */
  has?: (frame: FrameMessage) => boolean;
}

const INTERSECTIONS = ["intersection", "penetration"];
const POINTS: Pick<LayerRow, "lists" | "kinds"> = { lists: ["contact_points", ...drawnAs("contact").filter((list) => list !== "contacts")], kinds: [...INTERSECTIONS, "continuous"] };

/** What is drawn, then marks of contacts, then the stages of the search. */
export const LAYER_ROWS: LayerRow[] = [
  { layer: "surface", label: "Surfaces", key: "S", colour: "", hint: "The objects" },
  { layer: "wireframe", label: "Wireframe", key: "X", colour: "", hint: "The edges of all triangles" },
  { layer: "triangles", label: "Intersecting triangles", key: "I", colour: MARKS.contact, hint: "Triangles that have a contact", ...POINTS, lists: drawnAs("contact") },
  { layer: "points", label: "Contact points", key: "D", colour: MARKS.contact, hint: "Extreme points of the intersection of two triangles", ...POINTS },
  { layer: "normals", label: "Contact normals", key: "Y", colour: MARKS.normal, hint: "The normal at each contact point", ...POINTS },
  { layer: "segments", label: "Contact segments", key: "U", colour: MARKS.contact, hint: "Segments and outlines in which pairs of triangles intersect", lists: ["contact_points"], kinds: INTERSECTIONS },
  { layer: "proximity", label: "Proximity pairs", key: "M", colour: "gaps", hint: "Closest points within the margins. Rings are coloured by distance: brown up to a quarter of the margins, then olive, green and blue", lists: drawnAs("gaps") },
  { layer: "depths", label: "Depths", key: "E", colour: MARKS.depth, hint: "From each vertex inside a solid object to the closest point of its surface", lists: drawnAs("depths") },
  { layer: "curves", label: "Curves", key: "A", colour: MARKS.curve, hint: "The triangles at the vertices that each curve of intersections encloses, and an arrow along the normal, as far as the first object must move to pass the second", lists: drawnAs("curves"), kinds: ["penetration"] },
  { layer: "pairs", label: "Object pairs", key: "P", colour: MARKS.pair, hint: "Objects whose volumes overlap" },
  { layer: "candidates", label: "Candidate pairs", key: "C", colour: MARKS.candidate, hint: "Pairs of triangles that the exact stage decides" },
  { layer: "nodes", label: "Colliding nodes", key: "K", colour: "levels", hint: "Nodes of two octrees whose volumes overlap in the narrow phase: the leaves, or a level chosen under Narrow phase" },
  { layer: "octree", label: "Object octrees", key: "B", colour: "levels", hint: "Cells of the objects' octrees, coloured by level" },
  { layer: "regions", label: "Scene octree", key: "N", colour: "levels", hint: "Regions that the broad phase used in this frame, coloured by level; none unless the octree ran", has: ({ text }) => text.broad_phase_method === "octree" },
  { layer: "vertices", label: "Colliding vertices", key: "J", colour: MARKS.vertex, hint: "The output of the paper: vertices of colliding octree nodes" },
];
