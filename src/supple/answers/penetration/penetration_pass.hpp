#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "answers/pass.hpp"
#include "answers/penetration/manifold_methods.hpp"
#include "answers/question.hpp"
#include "contact/distance/distance_batch.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "mesh/vertex_sets.hpp"
#include "octree/morton_curve.hpp"
#include "queries/object_queries.hpp"
#include "supple/options.hpp"
#include "supple/penetration.hpp"
#include "supple/result.hpp"

namespace supple {

/// The lists of the result.
struct PenetrationLists {
  std::vector<Penetration> penetrations;
  std::vector<std::uint32_t> on_surface;
  std::vector<ContainedPart> parts;
  CurveLists curves;

  /// In the order of `PenetrationPass::List`.
  auto all() {
    return std::tie(penetrations, on_surface, parts, curves.curves, curves.contacts, curves.points,
                    curves.enclosed);
  }
};

/// What a search for penetrations reads besides the objects.
struct PenetrationSearch {
  const DetectResult& found;  ///< all contacts of the jobs
  bool curves = false;
};

/// Finds what objects that intersect or contain each other do: vertices inside solids, contained parts, and
/// curves.
///
/// Vertices inside b: an edge of a that has no point in common with b has both ends inside b, or both
/// outside. The contacts name all edges and vertices of a that have such a point (`intersect_triangles` lists
/// every extreme point, and a face of a convex set has an extreme point of it). So the vertices that other
/// edges connect are alike, and one query decides for all of them. If such a set holds no corner of a
/// triangle with a contact, it is a whole connected part of a. So one query for each connected part without
/// contacts, and one for each set of corners of triangles with contacts, leave no vertex out. Only sets that
/// are inside are walked through.
///
/// The pass reuses what it found for two objects that have not moved since the previous run. It keeps its
/// memory between steps.
class PenetrationPass {
 public:
  using Object = PenetratedObject;
  static constexpr ContactKinds answers = ContactKinds::penetration;
  static PenetrationSearch search_of(const Question& question, const DetectResult& found) {
    return {found, question.curves};
  }
  /// Returns false when it was stopped; the lists are then not valid.
  bool run(const PassInput& input, std::span<const PenetratedObject> objects, const PenetrationSearch& search,
           StepStats& stats);

  /// Adds the lists to a result.
  void list(DetectResult& found) const {
    found.penetration_groups = groups_;
    found.penetrations = found_.penetrations;
    found.vertices_on_surface = found_.on_surface;
    found.contained_parts = found_.parts;
    found.curves = found_.curves.curves;
    found.curve_contacts = found_.curves.contacts;
    found.curve_points = found_.curves.points;
    found.enclosed_vertices = found_.curves.enclosed;
  }
  /// Calls `visit(list)` for each list of the result.
  template <class Visit>
  void visit_lists(const Visit& visit) {
    visit(groups_);
    std::apply([&](auto&... list) { (visit(list), ...); }, found_.all());
  }

 private:
  /// The vertices of one object, `inner`, inside another one, and the curves of the two. The curves belong to
  /// the task with the smaller object inside.
  struct Task {
    std::uint32_t inner = 0, outer = 0;
    const ContactGroup* group = nullptr;  // of both
  };
  /// The lists of the result in `JobOutcomes`. The contacts of the curves of a task are those of its group,
  /// in another order, so both have the same range of their lists.
  enum List : std::size_t {
    of_penetrations,
    of_surface,
    of_parts,
    of_curves,
    of_curve_contacts,
    of_curve_points,
    of_enclosed,
    list_count
  };
  using Outcomes = JobOutcomes<list_count>;
  struct Worker {
    std::unique_ptr<CurveMaker> curve_maker;  // null until a step asks for curves
    ObjectQueries queries;
    DistanceBatch distances;
    PenetrationLists found;
    // Scratch of `sort_by_place`.
    std::vector<std::uint32_t> numbers;
    std::vector<Vec3d> points;
    std::vector<CurvePlace> order, memory;
    // Scratch of one task.
    std::vector<std::uint32_t> inside;
    std::vector<std::array<std::uint32_t, 2>> cut_edges;
    std::vector<std::uint32_t> corners, triangles;
    std::vector<std::uint32_t> corner_of;  // by vertex: its place in `corners`, if it is there
    VertexSets sets;
    std::vector<Containment> state;         // by set
    std::vector<std::uint8_t> marks;        // by vertex; zero between tasks
    bool has_marks = false;                 // a task did not end, because memory ran out
    std::vector<std::uint8_t> has_contact;  // by part
  };

  void list_pairs(std::span<const ContactJob> jobs);
  Task task_of(ContactJob pair, const DetectResult& result) const;
  void run_task(const Task& task, const DetectResult& result, Worker& worker) const;
  void find_inside(const Task& task, const DetectResult& result, Worker& worker) const;
  void collect_touched(const Task& task, const DetectResult& result, Worker& worker) const;
  void gather();
  void copy_found(std::size_t i);
  void renumber_curves(std::size_t i);
  bool find_depths(const StopSignal& stop, const Parallel& parallel);
  void sort_by_place(std::span<std::uint32_t> penetrations, Worker& worker) const;
  void find_depths(std::span<const std::uint32_t> penetrations, Worker& worker);

  std::span<const PenetratedObject> objects_;
  bool with_curves_ = false;
  std::vector<Worker> workers_;
  std::vector<ContactJob> pairs_;  // inner and outer object, ascending
  Outcomes outcomes_;
  std::vector<std::uint32_t> new_penetrations_;  // whose depths are not known

  std::vector<PenetrationGroup> groups_;
  PenetrationLists found_;
};

}  // namespace supple
