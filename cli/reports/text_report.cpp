#include "reports/text_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/verify.hpp"

namespace supple::cli {
namespace {

void add_to(StepStats& sum, const StepStats& stats) {
  for_each_leaf(
      [](const auto&, auto& total, const auto& value) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) total += value;
      },
      sum, stats);
}

}  // namespace

TextReport::TextReport(std::string noun, const Input& input, const MovingObjects& objects)
    : noun_(std::move(noun)), input_(input), objects_(objects), self_contacts_(input, objects) {
  for (const InputObject& object : input.objects) triangles_ += object.mesh.triangles.size();
}

void TextReport::add(const Frame& frame) {
  const DetectResult& result = frame.result;
  ++frames_;
  for (const ContactGroup& group : result.groups) {
    PairSummary& pair = pairs_[{group.a, group.b}];
    ++pair.frames;
    pair.triangle_pairs += group.contact_count;
    if (group.contact_count <= pair.most) continue;
    pair.most = group.contact_count;
    pair.frame_of_most = frame.number;
  }
  triangle_pairs_ += result.contacts.size();
  for (const ContactGroup& group : result.proximity_groups) {
    NearSummary& near = near_[{group.a, group.b}];
    ++near.frames;
    if (near.pairs == 0) near.smallest = result.proximity_pairs_of(group).front().distance;
    near.pairs += group.contact_count;
    for (const ProximityPair& pair : result.proximity_pairs_of(group))
      near.smallest = std::min(near.smallest, pair.distance);
  }
  for (const PenetrationGroup& group : result.penetration_groups) {
    if (group.penetration_count == 0) continue;
    InsideSummary& inside = inside_[{group.a, group.b}];
    ++inside.frames;
    inside.vertices += group.penetration_count;
    for (const Penetration& p : result.penetrations_of(group)) {
      if (p.depth <= inside.deepest) continue;
      inside.deepest = p.depth;
      inside.deepest_vertex = p.vertex;
      inside.frame_of_deepest = frame.number;
    }
  }
  ObjectPair last_contained;
  for (const ContainedPart& part : result.contained_parts) {
    const ObjectPair pair{part.inner, part.outer};
    if (part.is_whole && std::exchange(last_contained, pair) != pair) ++inside_[pair].frames_contained;
  }
  for (const IntersectionCurve& curve : result.curves) {
    ++(curve.kind == CurveKind::closed ? closed_curves_
       : curve.kind == CurveKind::open ? open_curves_
                                       : branched_curves_);
  }
  impacts_.add(frame);
  self_contacts_.add(result);
  add_to(sum_, result.stats);
  if (frame.simulated) {
    simulated_ = true;
    motion_seconds_ += frame.simulated->motion_seconds;
  }
  volumes_begun_ += result.volume_events.begin.size();
  leaves_begun_ += result.narrow_phase_events.begin.size();
  near_begun_ += result.proximity_events.begin.size();
  begun_ += result.contact_events.begin.size();
  ended_ += result.contact_events.end.size();
  non_finite_ = result.non_finite_vertices.size();
  if (!frame.verify) return;
  verified_ = true;
  const VerifyReport& verify = *frame.verify;
  checked_ += verify.triangle_pairs_checked + verify.element_pairs_checked + verify.proximity_pairs_checked +
              verify.vertex_triangle_pairs_checked;
  differences_ += verify.difference_count();
}

void TextReport::print(const TestedKinds& tested) const {
  const std::string ranks =
      objects_.rank_count() > 1 ? fmt::format(", {} ranks", objects_.rank_count()) : std::string();
  fmt::print("{}, {}, {}{}\n\n", counted(input_.objects.size(), "object"), counted(triangles_, "triangle"),
             counted(frames_, noun_), ranks);
  print_contacts(tested);
  if (simulated_) print_collisions();
  print_stages();
  if (non_finite_ > 0)
    fmt::print("\n{} not finite in the last frame: the triangles that use these vertices touch nothing\n",
               counted(non_finite_, "position"));
  if (verified_) print_verify();
}

/// Leaves out "Nothing touches." for kinds of contacts that were not tested.
void TextReport::print_contacts(const TestedKinds& tested) const {
  if (tested.was_tested(ContactKinds::intersection)) {
    print_pairs();
    if (contains(input_.simulation.scene.contacts, ContactKinds::penetration)) print_curves();
  }
  if (tested.was_tested(ContactKinds::penetration)) print_penetrations();
  if (tested.was_tested(ContactKinds::continuous)) impacts_.print(input_);
  if (tested.was_tested(ContactKinds::proximity)) print_near();
  for (std::vector<std::string> lines : {tested.faults(), self_contacts_.notes()}) {
    for (std::string& line : lines) {
      line.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(line.front())));
      fmt::print("{}.\n\n", line);
    }
  }
}

void TextReport::print_near() const {
  if (near_.empty()) {
    fmt::print("Nothing is within the margins.\n\n");
    return;
  }
  std::vector<std::pair<ObjectPair, NearSummary>> rows(near_.begin(), near_.end());
  std::sort(rows.begin(), rows.end(), [](const auto& x, const auto& y) {
    return x.second.pairs != y.second.pairs ? x.second.pairs > y.second.pairs : x.first < y.first;
  });
  const bool lists_features = input_.simulation.scene.proximity_listing == ProximityListing::features;
  fmt::print("{:<20} {:<20} {:>8} {:>16} {:>24}\n", "object", "is near", "frames",
             lists_features ? "feature pairs" : "element pairs", "smallest distance");
  for (std::size_t i = 0; i < std::min(rows.size(), most_rows); ++i) {
    const auto& [pair, near] = rows[i];
    fmt::print("{:<20} {:<20} {:>8} {:>16} {:>24}\n", name_of(input_, pair.a),
               pair.a == pair.b ? "itself" : name_of(input_, pair.b), grouped(near.frames),
               grouped(near.pairs), near.smallest);
  }
  if (rows.size() > most_rows)
    fmt::print("and {} with fewer; --csv lists all\n", counted(rows.size() - most_rows, "pair"));
  fmt::print("\n");
}

void TextReport::print_curves() const {
  fmt::print("The intersections form {} ({} closed, {} open, {} branched).\n\n",
             counted(closed_curves_ + open_curves_ + branched_curves_, "curve"), grouped(closed_curves_),
             grouped(open_curves_), grouped(branched_curves_));
}

void TextReport::print_penetrations() const {
  if (inside_.empty()) {
    fmt::print("No vertex is inside a solid object.\n\n");
    return;
  }
  std::vector<std::pair<ObjectPair, InsideSummary>> rows(inside_.begin(), inside_.end());
  std::sort(rows.begin(), rows.end(), [](const auto& x, const auto& y) {
    return x.second.vertices != y.second.vertices ? x.second.vertices > y.second.vertices : x.first < y.first;
  });
  fmt::print("{:<20} {:<20} {:>8} {:>16} {:>24} {:>12} {:>16}\n", "object", "is inside", "frames",
             "vertices inside", "largest depth", "in frame", "frames, wholly");
  for (std::size_t i = 0; i < std::min(rows.size(), most_rows); ++i) {
    const auto& [pair, inside] = rows[i];
    fmt::print("{:<20} {:<20} {:>8} {:>16} {:>24} {:>12} {:>16}\n", name_of(input_, pair.a),
               name_of(input_, pair.b), grouped(inside.frames), grouped(inside.vertices), inside.deepest,
               inside.frame_of_deepest, grouped(inside.frames_contained));
  }
  if (rows.size() > most_rows)
    fmt::print("and {} with fewer; --csv lists all\n", counted(rows.size() - most_rows, "pair"));
  const auto& [pair, deepest] = *std::ranges::max_element(
      rows, [](const auto& x, const auto& y) { return x.second.deepest < y.second.deepest; });
  if (deepest.vertices > 0)
    fmt::print("\nThe deepest is vertex {} of {} inside {}: {} in {} {}.\n", deepest.deepest_vertex,
               name_of(input_, pair.a), name_of(input_, pair.b), deepest.deepest, noun_,
               deepest.frame_of_deepest);
  fmt::print("\n");
}

void TextReport::print_pairs() const {
  if (pairs_.empty()) {
    const bool finds_only_these = input_.simulation.scene.contacts == ContactKinds::intersection;
    fmt::print("{}\n\n", finds_only_these ? "Nothing touches." : "No triangles intersect.");
    return;
  }
  std::vector<std::pair<ObjectPair, PairSummary>> rows(pairs_.begin(), pairs_.end());
  std::sort(rows.begin(), rows.end(), [](const auto& x, const auto& y) {
    if (x.second.triangle_pairs != y.second.triangle_pairs)
      return x.second.triangle_pairs > y.second.triangle_pairs;
    return x.first < y.first;
  });
  const std::size_t left_out = rows.size() - std::min(rows.size(), most_rows);
  rows.resize(rows.size() - left_out);

  fmt::print("{:<20} {:<20} {:>8} {:>16} {:>16} {:>12}\n", "object", "touches", "frames", "triangle pairs",
             "most in a frame", "in frame");
  for (const auto& [pair, summary] : rows) {
    fmt::print("{:<20} {:<20} {:>8} {:>16} {:>16} {:>12}\n", name_of(input_, pair.a),
               pair.a == pair.b ? "itself" : name_of(input_, pair.b), grouped(summary.frames),
               grouped(summary.triangle_pairs), grouped(summary.most), summary.frame_of_most);
  }
  if (left_out > 0) fmt::print("and {} with fewer; --json lists all\n", counted(left_out, "pair"));
  fmt::print("\n{} that {}; pairs of objects began to touch {} and separated {}\n\n",
             counted(triangle_pairs_, "triangle pair"), triangle_pairs_ == 1 ? "intersects" : "intersect",
             counted(begun_, "time"), counted(ended_, "time"));
}

void TextReport::print_collisions() const {
  fmt::print("collisions: {} that two objects' volumes began to overlap, ", counted(volumes_begun_, "time"));
  if (input_.simulation.scene.comparison.colliding_vertices)
    fmt::print("{} that leaves of two objects' octrees did, ", counted(leaves_begun_, "time"));
  if (contains(input_.simulation.scene.contacts, ContactKinds::proximity))
    fmt::print("{} that two objects came within their margins, ", counted(near_begun_, "time"));
  fmt::print("{} that two objects began to touch\n\n", counted(begun_, "time"));
}

void TextReport::print_stages() const {
  const double frames = static_cast<double>(std::max<std::uint64_t>(frames_, 1));
  const double total_seconds = sum_.total_seconds + motion_seconds_;
  const auto row = [&](const char* stage, double seconds, const std::string& work) {
    const double share = total_seconds > 0 ? 100 * seconds / total_seconds : 0;
    fmt::print("{:<12} {:>14.3f} {:>7.0f} %   {}\n", stage, 1e3 * seconds / frames, share, work);
  };
  fmt::print("{:<12} {:>14} {:>9}   in all {}s\n", "stage", fmt::format("ms per {}", noun_), "share", noun_);
  if (simulated_) row("motion", motion_seconds_, "");
  row("refit", sum_.refit_seconds, counted(sum_.triangles_refitted, "triangle"));
  row("broad phase", sum_.broad_phase_seconds,
      fmt::format("{} of {} tested", counted(sum_.object_pairs, "object pair"),
                  grouped(sum_.object_pairs_tested)));
  row("rebuild", sum_.rebuild_seconds,
      fmt::format("{} in {}", counted(sum_.triangles_rebuilt, "triangle"),
                  counted(sum_.octrees_rebuilt, "octree")));
  row("traversal", sum_.traversal_seconds,
      fmt::format("{} from {}",
                  counted(sum_.candidate_pairs + sum_.vertex_face_candidates + sum_.edge_edge_candidates,
                          "candidate"),
                  counted(sum_.boxes_tested, "box test")));
  row("exact", sum_.exact_seconds,
      fmt::format("{}{}, {} decided by exact arithmetic", counted(sum_.contacts, "contact"),
                  sum_.proximity_pairs > 0 ? ", " + counted(sum_.proximity_pairs, "near pair") : "",
                  grouped(sum_.exact_fallbacks)));
  if (contains(input_.simulation.scene.contacts, ContactKinds::penetration))
    row("penetration", sum_.penetration_seconds,
        fmt::format("{} inside, {}", counted(sum_.penetrations, "vertex", "vertices"),
                    counted(sum_.curves, "curve")));
  if (input_.simulation.scene.manifolds) row("manifolds", sum_.manifold_seconds, "");
  row("sort, events", sum_.sort_and_events_seconds, "");
  row("total", total_seconds, "");
}

void TextReport::print_verify() const {
  const char* const noun = contains(input_.simulation.scene.contacts, ContactKinds::penetration)
                               ? "pair of triangles, elements, or vertex and triangle"
                           : input_.simulation.scene.contacts == ContactKinds::intersection ? "triangle pair"
                           : !contains(input_.simulation.scene.contacts, ContactKinds::intersection)
                               ? "element pair"
                               : "triangle and element pair";
  fmt::print("\nverified: {} checked by brute force, {}\n", counted(checked_, noun),
             differences_ == 0 ? "no difference" : counted(differences_, "difference"));
}

}  // namespace supple::cli
