/** Sentences for the stages that can separate two triangles, by the words of the session. */
export const STAGES: Record<string, string> = {
  not_tested: "Not tested",
  shared_vertex: "They share a vertex",
  inert: "A corner is not finite",
  object_volumes: "Broad phase: the objects are apart",
  octree_volumes: "Narrow phase: octree cells are apart",
  triangle_boxes: "Leaves: the boxes of the triangles are apart",
  exact_test: "Exact stage: the triangles are apart",
  contact: "They are a contact",
};
