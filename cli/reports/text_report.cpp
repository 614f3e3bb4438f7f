#include "reports/reports.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"
#include "reports/result_json.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/topology.hpp"
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

/// The vertices of an element of the contact on side 'a' or 'b'.
template <class Contact>
std::vector<std::uint32_t> vertices_of(const TriangleMesh& mesh, const Contact& contact, char side) {
  const auto corners = [&](std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return std::vector<std::uint32_t>(t.begin(), t.end());
  };
  if constexpr (std::is_same_v<Contact, supple::Contact>) {
    return corners(side == 'a' ? contact.triangle_a : contact.triangle_b);
  } else {
    const auto& element = side == 'a' ? contact.element_a : contact.element_b;
    const FeatureKind kind = kind_of_element(contact, side);
    if (kind == FeatureKind::face) return corners(element[0]);
    return {element.begin(), element.begin() + (kind == FeatureKind::edge ? 2 : 1)};
  }
}

}  // namespace

/// Whether the two elements have vertices at equal positions.
template <class Contact>
bool SelfContacts::is_at_seam(const Contact& contact) const {
  const TriangleMesh& mesh = input_.objects[contact.object_a.index].mesh;
  const std::span<const Vec3d> positions = objects_.positions(contact.object_a);
  const std::vector<std::uint32_t> a = vertices_of(mesh, contact, 'a'), b = vertices_of(mesh, contact, 'b');
  return std::ranges::any_of(a, [&](std::uint32_t v) {
    return std::ranges::any_of(b, [&](std::uint32_t w) { return positions[v] == positions[w]; });
  });
}

void SelfContacts::add(const DetectResult& result) {
  const auto add_all = [&](const auto& contacts) {
    for (const auto& contact : contacts) {
      if (contact.object_a != contact.object_b || input_.objects[contact.object_a.index].options.weld)
        continue;
      Counts& counts = counts_[contact.object_a];
      ++counts.all;
      if (is_at_seam(contact)) ++counts.at_seams;
    }
  };
  add_all(result.contacts);
  add_all(result.continuous_contacts);
  add_all(result.proximity_pairs);
}

std::vector<std::string> SelfContacts::notes() const {
  std::vector<std::string> notes;
  for (const auto& [object, counts] : counts_) {
    if (2 * counts.at_seams <= counts.all) continue;
    notes.push_back(
        fmt::format("{} of {} of {} with itself {} between vertices at equal positions, as at the seams of "
                    "an export; --weld makes such vertices one",
                    grouped(counts.at_seams), counted(counts.all, "contact"), name_of(input_, object),
                    counts.at_seams == 1 ? "is" : "are"));
  }
  if (const std::string note = note_of_neighbours(); !note.empty()) notes.push_back(note);
  return notes;
}

std::string SelfContacts::note_of_neighbours() const {
  if (!contains(input_.simulation.scene.contacts, ContactKinds::intersection)) return "";
  std::uint64_t pairs = 0;
  for (const InputObject& object : input_.objects) {
    if (!object.options.self_collision || object.options.neighbours == Neighbours::exact) continue;
    pairs +=
        count_neighbour_pairs(object.options.weld ? welded(object.mesh).triangles : object.mesh.triangles);
  }
  if (pairs == 0) return "";
  return fmt::format("{} that share a vertex {} not tested; --neighbours exact tests them",
                     counted(pairs, "pair of triangles", "pairs of triangles"), pairs == 1 ? "was" : "were");
}

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
    pair.count += group.contact_count;
    if (group.contact_count <= pair.most) continue;
    pair.most = group.contact_count;
    pair.frame_of_most = frame.number;
  }
  triangle_pairs_ += result.contacts.size();
  for (const ContactGroup& group : result.proximity_groups) {
    NearSummary& near = near_[{group.a, group.b}];
    ++near.frames;
    if (near.count == 0) near.smallest = result.proximity_pairs_of(group).front().distance;
    near.count += group.contact_count;
    for (const ProximityPair& pair : result.proximity_pairs_of(group))
      near.smallest = std::min(near.smallest, pair.distance);
  }
  for (const PenetrationGroup& group : result.penetration_groups) {
    if (group.penetration_count == 0) continue;
    InsideSummary& inside = inside_[{group.a, group.b}];
    ++inside.frames;
    inside.count += group.penetration_count;
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
  add_impacts(frame);
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

void TextReport::add_impacts(const Frame& frame) {
  const DetectResult& result = frame.result;
  if (result.continuous_contacts.empty()) return;
  const auto count_edges = [](std::span<const ContinuousContact> contacts) {
    return static_cast<std::uint64_t>(
        std::ranges::count(contacts, ElementPairKind::edge_edge, &ContinuousContact::kind));
  };
  for (const ContactGroup& group : result.continuous_groups) {
    ImpactSummary& pair = impacts_[{group.a, group.b}];
    ++pair.frames;
    pair.count += group.contact_count;
    pair.edge_edge += count_edges(result.continuous_contacts_of(group));
  }
  ++steps_with_impacts_;
  const std::uint64_t edges = count_edges(result.continuous_contacts);
  ImpactStep step{frame.number, result.continuous_contacts.size() - edges, edges};
  for (const ContinuousContact& contact : result.continuous_contacts) {
    step.earliest = std::min(step.earliest, contact.toi);
    if (contact.certainty == ImpactCertainty::within_tolerance) ++impacts_within_tolerance_;
  }
  if (impact_steps_.size() < most_rows) impact_steps_.push_back(step);
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
  if (tested.was_tested(ContactKinds::continuous)) print_impacts();
  if (tested.was_tested(ContactKinds::proximity)) print_near();
  for (std::vector<std::string> lines : {tested.faults(), self_contacts_.notes()}) {
    for (std::string& line : lines) {
      line.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(line.front())));
      fmt::print("{}.\n\n", line);
    }
  }
}

template <class Summary, class Cells>
void TextReport::print_table(const Summaries<Summary>& pairs, const char* option, const Cells& cells) const {
  std::vector<std::pair<ObjectPair, Summary>> rows(pairs.begin(), pairs.end());
  std::sort(rows.begin(), rows.end(), [](const auto& x, const auto& y) {
    return x.second.count != y.second.count ? x.second.count > y.second.count : x.first < y.first;
  });
  for (std::size_t i = 0; i < std::min(rows.size(), most_rows); ++i) {
    const auto& [pair, summary] = rows[i];
    fmt::print("{:<20} {:<20} {:>8} {}\n", name_of(input_, pair.a),
               pair.a == pair.b ? "itself" : name_of(input_, pair.b), grouped(summary.frames),
               cells(summary));
  }
  if (rows.size() > most_rows)
    fmt::print("and {} with fewer; {} lists all\n", counted(rows.size() - most_rows, "pair"), option);
}

void TextReport::print_near() const {
  if (near_.empty()) return fmt::print("Nothing is within the margins.\n\n");
  const bool lists_features = input_.simulation.scene.proximity_listing == ProximityListing::features;
  fmt::print("{:<20} {:<20} {:>8} {:>16} {:>24}\n", "object", "is near", "frames",
             lists_features ? "feature pairs" : "element pairs", "smallest distance");
  print_table(near_, "--csv", [](const NearSummary& near) {
    return fmt::format("{:>16} {:>24}", grouped(near.count), near.smallest);
  });
  fmt::print("\n");
}

void TextReport::print_curves() const {
  fmt::print("The intersections form {} ({} closed, {} open, {} branched).\n\n",
             counted(closed_curves_ + open_curves_ + branched_curves_, "curve"), grouped(closed_curves_),
             grouped(open_curves_), grouped(branched_curves_));
}

void TextReport::print_penetrations() const {
  if (inside_.empty()) return fmt::print("No vertex is inside a solid object.\n\n");
  fmt::print("{:<20} {:<20} {:>8} {:>16} {:>24} {:>12} {:>16}\n", "object", "is inside", "frames",
             "vertices inside", "largest depth", "in frame", "frames, wholly");
  print_table(inside_, "--csv", [](const InsideSummary& inside) {
    return fmt::format("{:>16} {:>24} {:>12} {:>16}", grouped(inside.count), inside.deepest,
                       inside.frame_of_deepest, grouped(inside.frames_contained));
  });
  // Of pairs that are equally deep, the report names the one with the most vertices.
  const auto& [pair, deepest] = *std::ranges::max_element(inside_, [](const auto& x, const auto& y) {
    return std::pair(x.second.deepest, x.second.count) < std::pair(y.second.deepest, y.second.count);
  });
  if (deepest.count > 0)
    fmt::print("\nThe deepest is vertex {} of {} inside {}: {} in {} {}.\n", deepest.deepest_vertex,
               name_of(input_, pair.a), name_of(input_, pair.b), deepest.deepest, noun_,
               deepest.frame_of_deepest);
  fmt::print("\n");
}

void TextReport::print_impacts() const {
  if (impacts_.empty()) return fmt::print("Nothing touches.\n\n");
  fmt::print("{:<20} {:>16} {:>16} {:>24}\n", "to frame", "vertex-face", "edge-edge", "earliest, 0 to 1");
  for (const ImpactStep& step : impact_steps_)
    fmt::print("{:<20} {:>16} {:>16} {:>24}\n", step.number, grouped(step.vertex_face),
               grouped(step.edge_edge), step.earliest);
  if (steps_with_impacts_ > impact_steps_.size())
    fmt::print("and {} in which something touches; --json lists all\n",
               counted(steps_with_impacts_ - impact_steps_.size(), "step"));
  fmt::print("\n{:<20} {:<20} {:>8} {:>16} {:>16}\n", "object", "touches", "steps", "vertex-face",
             "edge-edge");
  print_table(impacts_, "--json", [](const ImpactSummary& pair) {
    return fmt::format("{:>16} {:>16}", grouped(pair.count - pair.edge_edge), grouped(pair.edge_edge));
  });
  std::uint64_t all = 0;
  for (const auto& [pair, summary] : impacts_) all += summary.count;
  fmt::print("\n{} that touch within a step\n\n", counted(all, "pair of elements", "pairs of elements"));
  if (impacts_within_tolerance_ > 0)
    fmt::print("{} of them within tolerance only: floating point cannot decide whether they touch\n\n",
               grouped(impacts_within_tolerance_));
}

void TextReport::print_pairs() const {
  if (pairs_.empty()) {
    const bool finds_only_these = input_.simulation.scene.contacts == ContactKinds::intersection;
    return fmt::print("{}\n\n", finds_only_these ? "Nothing touches." : "No triangles intersect.");
  }
  fmt::print("{:<20} {:<20} {:>8} {:>16} {:>16} {:>12}\n", "object", "touches", "frames", "triangle pairs",
             "most in a frame", "in frame");
  print_table(pairs_, "--json", [](const PairSummary& pair) {
    return fmt::format("{:>16} {:>16} {:>12}", grouped(pair.count), grouped(pair.most), pair.frame_of_most);
  });
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
