#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "scene/contact_tasks.hpp"
#include "scene/curve_finder.hpp"
#include "scene/object_queries.hpp"
#include "scene/surface_view.hpp"
#include "supple/penetration.hpp"
#include "supple/result.hpp"

namespace supple {

/// The data of an object that the pass reads.
struct PenetratedObject {
  QueriedObject queried;
  SurfaceView surface;
  bool is_solid = false;
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
class PenetrationPass {
 public:
  /// `jobs` ascend and contain indices of `objects`; `result` has all contacts of the jobs. Returns false
  /// when it was stopped; the lists are then not valid.
  bool run(std::span<const ContactJob> jobs, std::span<const PenetratedObject> objects,
           const DetectResult& result, const StopSignal& stop, const Parallel& parallel);

  std::span<const PenetrationGroup> groups() const { return groups_; }
  std::span<const Penetration> penetrations() const { return penetrations_; }
  std::span<const std::uint32_t> vertices_on_surface() const { return on_surface_; }
  std::span<const ContainedPart> contained_parts() const { return parts_; }
  const CurveLists& curves() const { return curves_; }

 private:
  /// Part of a job: its curves, or the vertices of one object inside the other.
  struct Task {
    std::uint32_t inner = 0, outer = 0;
    const ContactGroup* group = nullptr;
    bool finds_curves = false;
    bool inner_is_b = false;
  };
  /// What a task found, as ranges of the lists of its worker.
  struct Outcome {
    std::uint32_t worker = 0;
    std::uint32_t first_curve = 0, curves = 0;
    std::uint32_t first_inside = 0, inside = 0;
    std::uint32_t first_on_surface = 0, on_surface = 0;
    std::uint32_t first_part = 0, parts = 0;
  };
  struct Worker {
    CurveFinder curve_finder;
    ObjectQueries queries;
    CurveLists curves;
    std::vector<std::uint32_t> inside, on_surface;
    std::vector<ContainedPart> parts;
    // Scratch of one task.
    std::vector<std::array<std::uint32_t, 2>> cut_edges;
    std::vector<std::uint32_t> corners, triangles, touched;
    ParitySets sets;
    std::vector<Containment> state;         // by set
    std::vector<std::uint8_t> marks;        // by vertex
    std::vector<std::uint8_t> has_contact;  // by part
  };

  void plan(std::span<const ContactJob> jobs, const DetectResult& result);
  void run_task(const Task& task, const DetectResult& result, Worker& worker, Outcome& outcome) const;
  void find_inside(const Task& task, const DetectResult& result, Worker& worker) const;
  void collect_touched(const Task& task, const DetectResult& result, Worker& worker) const;
  void gather();
  bool find_depths(const StopSignal& stop, const Parallel& parallel);

  std::span<const PenetratedObject> objects_;
  std::vector<Worker> workers_;
  std::vector<Task> tasks_;
  std::vector<Outcome> outcomes_;

  std::vector<PenetrationGroup> groups_;
  std::vector<Penetration> penetrations_;
  std::vector<std::uint32_t> on_surface_;
  std::vector<ContainedPart> parts_;
  CurveLists curves_;
};

}  // namespace supple
