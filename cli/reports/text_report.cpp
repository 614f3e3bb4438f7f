#include "reports/reports.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"
#include "reports/result_json.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/topology.hpp"

namespace supple::cli {
namespace {

void add_to(StepStats& sum, const StepStats& stats) {
  for_each_leaf(
      [](const auto&, auto& total, const auto& value) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) total += value;
      },
      sum, stats);
}

/// Tables of all frames together: the objects that touch, and the work and time of each stage.
class TextReport : public Report {
 public:
  TextReport(std::string noun, const Input& input, const MovingObjects& objects, const TestedKinds& tested)
      : noun_(std::move(noun)),
        input_(input),
        objects_(objects),
        tested_(tested),
        self_contacts_(input, objects) {
    for (const InputObject& object : input.objects) triangles_ += object.mesh.triangles.size();
  }

  void add(const Frame& frame) override {
    const DetectResult& result = frame.result;
    ++frames_;
    for_each_group(ContactKinds::intersection, result.groups, [&](const ContactGroup& group, Summary& pair) {
      pair.add(group.contact_count, static_cast<double>(group.contact_count), frame.number);
    });
    for_each_group(ContactKinds::continuous, result.continuous_groups,
                   [&](const ContactGroup& group, Summary& pair) {
                     pair.add(group.contact_count);
                     pair.part += count_edges(result.continuous_contacts_of(group));
                   });
    for_each_group(
        ContactKinds::proximity, result.proximity_groups, [&](const ContactGroup& group, Summary& pair) {
          const double smallest =
              std::ranges::min(result.proximity_pairs_of(group), {}, &ProximityPair::distance).distance;
          if (pair.count == 0) pair.most = -std::numeric_limits<double>::infinity();
          pair.add(group.contact_count, -smallest, frame.number);
        });
    for (const ContactKindInfo& of : other_kinds())
      for_each_group(of.kind, result.*of.groups,
                     [](const ContactGroup& group, Summary& pair) { pair.add(group.contact_count); });
    for (const PenetrationGroup& group : result.penetration_groups) {
      if (group.penetration_count == 0) continue;
      Summary& pair = summaries_[ContactKinds::penetration][{group.a, group.b}];
      const auto deepest = std::ranges::max_element(result.penetrations_of(group), {}, &Penetration::depth);
      if (pair.add(group.penetration_count, deepest->depth, frame.number)) pair.vertex = deepest->vertex;
    }
    ObjectPair last_contained;
    for (const ContainedPart& part : result.contained_parts) {
      const ObjectPair pair{part.inner, part.outer};
      if (part.is_whole && std::exchange(last_contained, pair) != pair)
        ++summaries_[ContactKinds::penetration][pair].part;
    }
    for (const IntersectionCurve& curve : result.curves) ++curves_[static_cast<std::size_t>(curve.kind)];
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
    checked_ += verify.triangle_pairs_checked + verify.element_pairs_checked +
                verify.proximity_pairs_checked + verify.vertex_triangle_pairs_checked;
    differences_ += verify.difference_count();
  }

  /// Prints to standard output.
  void finish(bool) override {
    const std::string ranks =
        objects_.rank_count() > 1 ? fmt::format(", {} ranks", objects_.rank_count()) : std::string();
    fmt::print("{}, {}, {}{}\n\n", counted(input_.objects.size(), "object"), counted(triangles_, "triangle"),
               counted(frames_, noun_), ranks);
    print_contacts();
    if (simulated_) print_collisions();
    print_stages();
    if (non_finite_ > 0)
      fmt::print("\n{} not finite in the last frame: the triangles that use these vertices touch nothing\n",
                 counted(non_finite_, "position"));
    if (verified_) print_verify();
  }

 private:
  /// The contacts of one kind of two objects.
  struct Summary {
    std::uint64_t frames = 0;  ///< in which there are some
    std::uint64_t count = 0;   ///< pairs of triangles or elements, or vertices inside
    std::uint64_t part = 0;    ///< of these, pairs of edges; or frames in which the whole object is inside
    /// The largest number of triangle pairs in a frame, the largest depth, or minus the smallest distance.
    double most = 0;
    std::uint64_t frame_of_most = 0;  ///< the first
    std::uint32_t vertex = 0;         ///< the deepest

    /// Returns whether this frame has the most so far.
    bool add(std::uint64_t number, double most_of_frame = 0, std::uint64_t frame = 0) {
      ++frames;
      count += number;
      if (!(most_of_frame > most)) return false;
      most = most_of_frame;
      frame_of_most = frame;
      return true;
    }
  };
  using Summaries = std::map<ObjectPair, Summary>;
  struct ImpactStep {
    std::uint64_t number = 0, vertex_face = 0, edge_edge = 0;
    double earliest = 1;
  };

  static std::uint64_t count_edges(std::span<const ContinuousContact> contacts) {
    return static_cast<std::uint64_t>(
        std::ranges::count(contacts, ElementPairKind::edge_edge, &ContinuousContact::kind));
  }

  static std::uint64_t count_in(const Summaries& pairs) {
    std::uint64_t count = 0;
    for (const auto& [pair, summary] : pairs) count += summary.count;
    return count;
  }

  void for_each_group(ContactKinds kind, std::span<const ContactGroup> groups, const auto& visit) {
    for (const ContactGroup& group : groups) visit(group, summaries_[kind][{group.a, group.b}]);
  }

  void add_impacts(const Frame& frame) {
    const std::span<const ContinuousContact> contacts = frame.result.continuous_contacts;
    if (contacts.empty()) return;
    ++steps_with_impacts_;
    const std::uint64_t edges = count_edges(contacts);
    ImpactStep step{frame.number, contacts.size() - edges, edges};
    for (const ContinuousContact& contact : contacts) {
      step.earliest = std::min(step.earliest, contact.toi);
      if (contact.certainty == ImpactCertainty::within_tolerance) ++impacts_within_tolerance_;
    }
    if (impact_steps_.size() < most_rows) impact_steps_.push_back(step);
  }

  /// Leaves out "Nothing touches." for kinds of contacts that were not tested.
  void print_contacts() {
    if (tested_.was_tested(ContactKinds::intersection)) {
      print_pairs();
      if (contains(scene_.contacts, ContactKinds::penetration))
        fmt::print("The intersections form {} ({} closed, {} open, {} branched).\n\n",
                   counted(curves_[0] + curves_[1] + curves_[2], "curve"), grouped(curves_[0]),
                   grouped(curves_[1]), grouped(curves_[2]));
    }
    if (tested_.was_tested(ContactKinds::penetration)) print_penetrations();
    if (tested_.was_tested(ContactKinds::continuous)) print_impacts();
    if (tested_.was_tested(ContactKinds::proximity)) print_near();
    for (const ContactKindInfo& of : other_kinds()) {
      if (tested_.was_tested(of.kind)) print_others(of.kind);
    }
    for (std::vector<std::string> lines : {tested_.faults(), self_contacts_.notes()}) {
      for (std::string& line : lines) {
        line.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(line.front())));
        fmt::print("{}.\n\n", line);
      }
    }
  }

  /// The pairs of objects with the most first. `cells(summary)` are the cells after the number of frames.
  void print_table(const Summaries& pairs, const char* option, const auto& cells) const {
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

  void print_pairs() {
    const Summaries& pairs = summaries_[ContactKinds::intersection];
    if (pairs.empty()) {
      const bool finds_only_these = scene_.contacts == ContactKinds::intersection;
      return fmt::print("{}\n\n", finds_only_these ? "Nothing touches." : "No triangles intersect.");
    }
    fmt::print("{:<20} {:<20} {:>8} {:>16} {:>16} {:>12}\n", "object", "touches", "frames", "triangle pairs",
               "most in a frame", "in frame");
    print_table(pairs, "--json", [](const Summary& pair) {
      return fmt::format("{:>16} {:>16} {:>12}", grouped(pair.count),
                         grouped(static_cast<std::uint64_t>(pair.most)), pair.frame_of_most);
    });
    fmt::print("\n{} that {}; pairs of objects began to touch {} and separated {}\n\n",
               counted(count_in(pairs), "triangle pair"), count_in(pairs) == 1 ? "intersects" : "intersect",
               counted(begun_, "time"), counted(ended_, "time"));
  }

  void print_penetrations() {
    const Summaries& pairs = summaries_[ContactKinds::penetration];
    if (pairs.empty()) return fmt::print("No vertex is inside a solid object.\n\n");
    fmt::print("{:<20} {:<20} {:>8} {:>16} {:>24} {:>12} {:>16}\n", "object", "is inside", "frames",
               "vertices inside", "largest depth", "in frame", "frames, wholly");
    print_table(pairs, "--csv", [](const Summary& pair) {
      return fmt::format("{:>16} {:>24} {:>12} {:>16}", grouped(pair.count), pair.most, pair.frame_of_most,
                         grouped(pair.part));
    });
    // When several pairs are equally deep, the report names the one with the most vertices.
    const auto& [pair, deepest] = *std::ranges::max_element(
        pairs, {}, [](const auto& entry) { return std::pair(entry.second.most, entry.second.count); });
    if (deepest.count > 0)
      fmt::print("\nThe deepest is vertex {} of {} inside {}: {} in {} {}.\n", deepest.vertex,
                 name_of(input_, pair.a), name_of(input_, pair.b), deepest.most, noun_,
                 deepest.frame_of_most);
    fmt::print("\n");
  }

  void print_impacts() {
    const Summaries& pairs = summaries_[ContactKinds::continuous];
    if (pairs.empty()) return fmt::print("Nothing touches.\n\n");
    fmt::print("{:<20} {:>16} {:>16} {:>24}\n", "to frame", "vertex-face", "edge-edge", "earliest, 0 to 1");
    for (const ImpactStep& step : impact_steps_)
      fmt::print("{:<20} {:>16} {:>16} {:>24}\n", step.number, grouped(step.vertex_face),
                 grouped(step.edge_edge), step.earliest);
    if (steps_with_impacts_ > impact_steps_.size())
      fmt::print("and {} in which something touches; --json lists all\n",
                 counted(steps_with_impacts_ - impact_steps_.size(), "step"));
    fmt::print("\n{:<20} {:<20} {:>8} {:>16} {:>16}\n", "object", "touches", "steps", "vertex-face",
               "edge-edge");
    print_table(pairs, "--json", [](const Summary& pair) {
      return fmt::format("{:>16} {:>16}", grouped(pair.count - pair.part), grouped(pair.part));
    });
    fmt::print("\n{} that touch within a step\n\n",
               counted(count_in(pairs), "pair of elements", "pairs of elements"));
    if (impacts_within_tolerance_ > 0)
      fmt::print("{} of them within tolerance only: floating point cannot decide whether they touch\n\n",
                 grouped(impacts_within_tolerance_));
  }

  void print_near() {
    const Summaries& pairs = summaries_[ContactKinds::proximity];
    if (pairs.empty()) return fmt::print("Nothing is within the margins.\n\n");
    const bool lists_features = scene_.proximity_listing == ProximityListing::features;
    fmt::print("{:<20} {:<20} {:>8} {:>16} {:>24}\n", "object", "is near", "frames",
               lists_features ? "feature pairs" : "element pairs", "smallest distance");
    print_table(pairs, "--csv", [](const Summary& pair) {
      return fmt::format("{:>16} {:>24}", grouped(pair.count), 0 - pair.most);
    });
    fmt::print("\n");
  }

  void print_others(ContactKinds kind) {
    const char* const item = list_infos()[place_of_answer(kind)].item;
    if (summaries_[kind].empty()) return fmt::print("There is no {}.\n\n", item);
    fmt::print("{:<20} {:<20} {:>8} {:>16}\n", "object", "and", "frames", fmt::format("{}s", item));
    print_table(summaries_[kind], "--csv",
                [](const Summary& pair) { return fmt::format("{:>16}", grouped(pair.count)); });
    fmt::print("\n");
  }

  void print_collisions() const {
    fmt::print("collisions: {} that two objects' volumes began to overlap, ",
               counted(volumes_begun_, "time"));
    if (scene_.comparison.colliding_vertices)
      fmt::print("{} that leaves of two objects' octrees did, ", counted(leaves_begun_, "time"));
    if (contains(scene_.contacts, ContactKinds::proximity))
      fmt::print("{} that two objects came within their margins, ", counted(near_begun_, "time"));
    fmt::print("{} that two objects began to touch\n\n", counted(begun_, "time"));
  }

  void print_stages() const {
    const double frames = static_cast<double>(std::max<std::uint64_t>(frames_, 1));
    const double total_seconds = sum_.total_seconds + motion_seconds_;
    const auto row = [&](const char* stage, double seconds, const std::string& work) {
      const double share = total_seconds > 0 ? 100 * seconds / total_seconds : 0;
      fmt::print("{:<12} {:>14.3f} {:>7.0f} %   {}\n", stage, 1e3 * seconds / frames, share, work);
    };
    fmt::print("{:<12} {:>14} {:>9}   in all {}s\n", "stage", fmt::format("ms per {}", noun_), "share",
               noun_);
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
    if (contains(scene_.contacts, ContactKinds::penetration))
      row("penetration", sum_.penetration_seconds,
          fmt::format("{} inside, {}", counted(sum_.penetrations, "vertex", "vertices"),
                      counted(sum_.curves, "curve")));
    if (scene_.manifolds) row("manifolds", sum_.manifold_seconds, "");
    row("sort, events", sum_.sort_and_events_seconds, "");
    row("total", total_seconds, "");
  }

  void print_verify() const {
    const char* const noun = contains(scene_.contacts, ContactKinds::penetration)
                                 ? "pair of triangles, elements, or vertex and triangle"
                             : scene_.contacts == ContactKinds::intersection ? "triangle pair"
                             : !contains(scene_.contacts, ContactKinds::intersection)
                                 ? "element pair"
                                 : "triangle and element pair";
    fmt::print("\nverified: {} checked by brute force, {}\n", counted(checked_, noun),
               differences_ == 0 ? "no difference" : counted(differences_, "difference"));
  }

  std::string noun_;
  const Input& input_;
  const SceneOptions& scene_ = input_.simulation.scene;
  const MovingObjects& objects_;
  const TestedKinds& tested_;
  std::uint64_t triangles_ = 0, frames_ = 0;  ///< triangles of the input
  /// By kind of contacts; of penetrations, a in b.
  std::map<ContactKinds, Summaries> summaries_;
  std::vector<ImpactStep> impact_steps_;  ///< the first that have contacts
  std::uint64_t steps_with_impacts_ = 0, impacts_within_tolerance_ = 0;
  std::array<std::uint64_t, 3> curves_{};  ///< by kind
  SelfContacts self_contacts_;
  StepStats sum_;
  std::uint64_t volumes_begun_ = 0, leaves_begun_ = 0, near_begun_ = 0, begun_ = 0, ended_ = 0;
  bool simulated_ = false;
  double motion_seconds_ = 0;
  std::uint64_t non_finite_ = 0;  ///< in the last frame
  bool verified_ = false;
  std::uint64_t checked_ = 0, differences_ = 0;
};

}  // namespace

std::unique_ptr<Report> make_text_report(std::string noun, const Input& input, const MovingObjects& objects,
                                         const TestedKinds& tested) {
  return std::make_unique<TextReport>(std::move(noun), input, objects, tested);
}

}  // namespace supple::cli
