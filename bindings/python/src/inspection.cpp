#include "supple/inspection.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "meshes.hpp"
#include "options.hpp"
#include "records.hpp"
#include "scene.hpp"
#include "supple/inspection_descriptions.hpp"
#include "supple/orientation.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/topology.hpp"

// The inside of a scene, and the connections of meshes.

namespace supple::python {
namespace {

nb::object number_of(const std::optional<std::uint64_t>& number) {
  return number ? nb::cast(*number) : nb::object(nb::none());
}
nb::tuple vector_of(const auto& v) {
  return nb::make_tuple(v.x, v.y, v.z);
}
nb::object box_of(const Aabb& box) {
  return box.empty() ? nb::object(nb::none())
                     : nb::object(nb::make_tuple(vector_of(box.min), vector_of(box.max)));
}
nb::object sphere_of(const BoundingSphere& sphere) {
  return sphere.empty() ? nb::object(nb::none())
                        : nb::object(nb::make_tuple(vector_of(sphere.center), sphere.radius));
}
nb::list slabs_of(const std::vector<Slab>& slabs) {
  nb::list list;
  for (const Slab& slab : slabs) list.append(nb::make_tuple(vector_of(slab.direction), slab.low, slab.high));
  return list;
}

nb::dict cell_of(const OctreeCell& cell) {
  nb::dict dict;
  dict["level"] = cell.level;
  dict["number"] = number_of(cell.number);
  dict["number_level"] = cell.number_level;
  dict["is_leaf"] = cell.is_leaf;
  dict["triangle_count"] = cell.triangle_count;
  dict["box"] = box_of(cell.box);
  dict["sphere"] = sphere_of(cell.sphere);
  dict["slabs"] = slabs_of(cell.slabs);
  return dict;
}
nb::list cells_of(const std::vector<OctreeCell>& cells) {
  nb::list list;
  for (const OctreeCell& cell : cells) list.append(cell_of(cell));
  return list;
}

nb::list regions_of(const std::vector<SceneRegion>& regions) {
  nb::list list;
  for (const SceneRegion& region : regions) {
    nb::dict dict;
    dict["number"] = region.number;
    dict["level"] = region.level;
    dict["box"] = box_of(region.box);
    dict["is_leaf"] = region.is_leaf;
    dict["object_count"] = region.object_count;
    list.append(dict);
  }
  return list;
}

nb::dict explanation_of(const PairExplanation& pair) {
  nb::dict dict;
  dict["stage"] = word_of(pair.stage);
  dict["box_a"] = box_of(pair.box_a);
  dict["box_b"] = box_of(pair.box_b);
  dict["sphere_a"] = sphere_of(pair.sphere_a);
  dict["sphere_b"] = sphere_of(pair.sphere_b);
  dict["slabs_a"] = slabs_of(pair.slabs_a);
  dict["slabs_b"] = slabs_of(pair.slabs_b);
  dict["level_a"] = pair.level_a;
  dict["level_b"] = pair.level_b;
  dict["number_a"] = number_of(pair.number_a);
  dict["number_b"] = number_of(pair.number_b);
  dict["axis"] = vector_of(pair.axis);
  dict["distance"] = pair.distance;
  return dict;
}

template <class Inspect>
auto inspect(SceneCore& core, const Inspect& inspect) {
  const CallGuard::Alone alone(core.guard());
  return inspect(SceneInspector(core.scene()));
}

}  // namespace

void bind_inspection(nb::module_& module) {
  module.def(
      "octree_cells",
      [](SceneCore& core, ObjectId id, std::optional<std::uint32_t> level) {
        return inspect(core, [&](const SceneInspector& s) { return cells_of(s.cells(id, level)); });
      },
      nb::arg(), nb::arg(), nb::arg().none());
  module.def("leaf", [](SceneCore& core, ObjectId id, std::uint32_t triangle) {
    return inspect(core, [&](const SceneInspector& s) { return cell_of(s.leaf(id, triangle)); });
  });
  module.def("node_pairs", [](SceneCore& core, ObjectId a, ObjectId b) {
    return inspect(core, [&](const SceneInspector& s) {
      const NodePairList list = s.node_pairs(a, b);
      std::vector<std::uint32_t> pairs;
      for (const NodePairList::Pair& pair : list.pairs) pairs.insert(pairs.end(), {pair.a, pair.b});
      return nb::make_tuple(cells_of(list.nodes_a), cells_of(list.nodes_b),
                            to_own_array<std::uint32_t>(std::move(pairs)), list.level_begin);
    });
  });
  module.def("octree_depth", [](SceneCore& core, ObjectId id) {
    return inspect(core, [&](const SceneInspector& s) { return s.octree_depth(id); });
  });
  module.def("octree_statistics", [](SceneCore& core, ObjectId id) {
    return inspect(core, [&](const SceneInspector& s) { return dict_of(s.octree_statistics(id)); });
  });
  module.def("bounds", [](SceneCore& core, ObjectId id) {
    return inspect(core, [&](const SceneInspector& s) { return box_of(s.bounds(id)); });
  });
  module.def(
      "regions",
      [](SceneCore& core, std::optional<ObjectId> id) {
        return inspect(
            core, [&](const SceneInspector& s) { return regions_of(id ? s.regions(*id) : s.regions()); });
      },
      nb::arg(), nb::arg().none());
  module.def("candidates", [](SceneCore& core, std::size_t limit) {
    return inspect(core, [&](const SceneInspector& s) {
      CandidateList list = s.candidates(limit);
      std::vector<std::uint32_t> numbers;
      for (const CandidatePair& pair : list.pairs)
        numbers.insert(numbers.end(),
                       {pair.object_a.index, pair.object_b.index, pair.triangle_a, pair.triangle_b});
      return nb::make_tuple(to_own_array<std::uint32_t>(std::move(numbers)), list.total);
    });
  });
  module.def("explain",
             [](SceneCore& core, ObjectId a, std::uint32_t triangle_a, ObjectId b, std::uint32_t triangle_b) {
               return inspect(core, [&](const SceneInspector& s) {
                 return explanation_of(s.explain(a, triangle_a, b, triangle_b));
               });
             });

  module.def("compute_topology", [](const MeshData& mesh) {
    const MeshTopology t = compute_topology(mesh.mesh);
    nb::dict dict;
    dict["vertices"] = t.vertices;
    dict["unused_vertices"] = t.unused_vertices;
    dict["triangles"] = t.triangles;
    dict["degenerate_triangles"] = t.degenerate_triangles;
    dict["edges"] = t.edges;
    dict["boundary_edges"] = t.boundary_edges;
    dict["odd_edges"] = t.odd_edges;
    dict["non_manifold_edges"] = t.non_manifold_edges;
    dict["components"] = t.components;
    dict["euler_characteristic"] = t.euler_characteristic;
    dict["closed"] = t.closed();
    dict["surface"] = describe_surface(t);
    return dict;
  });
  module.def("vertices_at_same_position", [](const Array& positions) {
    return to_own_array<std::uint32_t>(vertices_at_same_position(positions_of(positions)));
  });
  module.def("welded", [](const MeshData& mesh) { return MeshData{welded(mesh.mesh)}; });
  module.def("is_open_at_seams", [](const MeshData& mesh) { return is_open_at_seams(mesh.mesh); });
  module.def("fault_of_solid", [](const MeshData& mesh) { return fault_of_solid(mesh.mesh); });
  module.def("count_inward_triangles",
             [](const MeshData& mesh) { return count_inward_triangles(mesh.mesh); });
  module.def("split_into_parts", [](const MeshData& mesh, bool weld) {
    nb::list list;
    for (MeshPart& part : split_into_parts(mesh.mesh, weld))
      list.append(nb::make_tuple(MeshData{std::move(part.mesh)},
                                 to_own_array<std::uint32_t>(std::move(part.vertices)),
                                 to_own_array<std::uint32_t>(std::move(part.triangles))));
    return list;
  });
}

}  // namespace supple::python
