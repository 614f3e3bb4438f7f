#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "answers/element_candidates.hpp"
#include "answers/first_contacts.hpp"
#include "answers/pass.hpp"
#include "answers/question.hpp"
#include "answers/search_options.hpp"
#include "contact/impact/impact_filter.hpp"
#include "contact/impact/relative_motion.hpp"
#include "contact/intersection/coplanar_search.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "supple/contact.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/safe_step.hpp"

namespace supple {

/// The pair of elements of a contact.
inline LimitingPair pair_of_contact(const ContinuousContact& contact) {
  return {contact.object_a, contact.object_b, contact.kind, contact.element_a, contact.element_b};
}

/// What a worker of `ImpactPass` has.
struct ImpactWorker : PassWorker<ContinuousContact> {
  /// A pair of elements that passed the filter.
  struct OpenPair {
    ElementPair candidate;
    std::array<std::uint32_t, 4> vertices;
    ElementMotion motion;
    RelativeMotion relative;
  };
  /// A contact without its numbers, and where it is stored.
  struct Key {
    ElementPairKind kind = ElementPairKind::vertex_face;
    std::array<std::uint32_t, 2> element_a{}, element_b{};
    std::uint32_t worker = 0, index = 0;

    auto operator<=>(const Key&) const = default;
  };
  struct Earliest {
    ContinuousContact contact;
    std::uint32_t job = 0;
  };
  /// A pair that limits the step of a job, and the part of the step that it leaves.
  struct StepLimit {
    std::uint32_t job = 0;
    double time = 1;
    LimitingPair pair;
  };
  /// Elements that are so near in the step that rounded positions could touch. Those that share a point at
  /// the start do not move together.
  struct NearPair {
    StepLimit limit;
    bool touches = false;    ///< at the start
    bool is_turned = false;  ///< the first element of the motion is that of b
    std::array<std::uint32_t, 4> vertices;
    ElementMotion motion;
  };

  RelativeMotionBlock block;
  std::array<OpenPair, RelativeMotionBlock::capacity> open;  // pairs of one block of candidates
  MotionBlock motions;                                       // of these pairs
  CoplanarSearch coplanar;
  FirstContacts first_contacts;
  std::size_t keep_first_at = 0;  // number of contacts of the present task
  std::optional<Earliest> earliest;
  std::vector<StepLimit> limits;  // the first of the job of each task
  std::vector<NearPair> near;
  std::vector<Key> sorted;  // of the contacts of one job

  void start() {
    earliest.reset();
    limits.clear();
    near.clear();
  }
};

/// What the searches of all processes of one scene found first, from what the search of this one found; a
/// step without a limit is nothing. It is stopped when one of them is.
using FirstOfAll = std::function<SafeStep(const SafeStep&)>;

/// Narrow phase and exact stage of continuous contacts for all jobs of a step, on all workers. The narrow
/// phase hands its candidates to the exact stage in batches.
class ImpactPass : public Pass<ImpactPass, MovingObject, ImpactWorker, ContinuousContact> {
 public:
  static constexpr ContactKinds answers = ContactKinds::continuous;
  static constexpr auto list_of_records = &DetectResult::continuous_contacts;
  static ImpactSearchOptions search_of(const Question& question, const DetectResult&) {
    return question.impact;
  }
  /// Finds the first `max_contacts` contacts in canonical order, for any number of threads. Returns false
  /// when it was stopped; the lists are then not valid.
  bool run(const PassInput& input, std::span<const MovingObject> objects, const ImpactSearchOptions& options,
           StepStats& stats);
  /// The contact with the earliest time; the first in canonical order among equal times. Nothing when it was
  /// stopped. Does not change the lists.
  std::optional<ContinuousContact> find_earliest(const PassInput& input,
                                                 std::span<const MovingObject> objects,
                                                 const ImpactSearchOptions& options);
  /// See `Scene::collision_free_step`, and `Scene::max_step` without `step`. With `first_of_all`, all
  /// processes make the same calls of it. Does not change the lists.
  SafeStep find_safe_step(const PassInput& input, std::span<const MovingObject> objects,
                          const ImpactSearchOptions& options, const std::optional<StepOptions>& step,
                          const FirstOfAll& first_of_all);
  /// See `Scene::collision_free_steps`. One step for each element of `objects`; those of no job have the step
  /// 1. Does not change the lists.
  std::vector<ObjectStep> find_safe_steps(const PassInput& input, std::span<const MovingObject> objects,
                                          const ImpactSearchOptions& options, const StepOptions& step);

  /// What the searches of the last call for a step or the earliest contact tested.
  const StepStats& work() const { return work_; }
  std::span<const ContinuousContact> contacts() const {
    return lists_first() ? first_contacts_.contacts() : records_;
  }
  void list(DetectResult& found) const {
    Pass::list(found);
    found.continuous_contacts = contacts();
  }
  template <class Visit>
  void visit_lists(const Visit& visit) {
    Pass::visit_lists(visit);
    first_contacts_.visit_lists(visit);
  }

 private:
  friend Pass;
  using OpenPair = ImpactWorker::OpenPair;
  using Earliest = ImpactWorker::Earliest;
  using StepLimit = ImpactWorker::StepLimit;
  using NearPair = ImpactWorker::NearPair;
  /// `longest`: the earliest contact of elements that do not part. `safe_step`: the parts of the step that
  /// keep distances. `free`: pairs that may not keep them when both objects move by any parts until the time.
  /// From `longest` on, elements that touch at the start do not count.
  enum class Search : std::uint8_t { all, earliest, longest, safe_step, free };

  /// Plans and runs the tasks of `jobs`, which are indices into `jobs_`, each until the time that `latest_`
  /// has for it.
  void search(Search search, std::span<const std::uint32_t> jobs, const Parallel& parallel);
  /// The same for all jobs until a time in the step.
  void search_until(Search search, float until, const Parallel& parallel);
  /// The earliest of `search`, which is `earliest` or `longest`.
  const Earliest* search_earliest(Search search, float until, const Parallel& parallel);
  void start(const PassInput& input, std::span<const MovingObject> objects,
             const ImpactSearchOptions& options);
  ImpactOptions impact_of_job(std::uint32_t job) const;
  /// The distance within which the pass searches, and what a safe step adds to it until a time: a share of
  /// the largest approach, or of the largest distance at the start in a block of pairs.
  double searched_distance(std::uint32_t job) const;
  double kept_distance(std::uint32_t job, float latest, const RelativeMotionBlock& block,
                       std::size_t count) const;
  double share_of_approach() const;
  /// By how much rounding may bring two vertices of the job nearer in a part of a step: `rounding_of_job`
  /// plus the part times `growth_of_rounding`.
  double rounding_of_job(std::uint32_t job) const;
  double growth_of_rounding(std::uint32_t job) const;
  /// What the distance within which the pass searches grows by over the whole step.
  double growth_of_distance(std::uint32_t job) const;
  double largest_approach(std::uint32_t job) const;
  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(std::size_t task, Worker& worker);
  void test_candidates(std::uint32_t job, ElementPairKind kind, std::span<const ElementPair> candidates,
                       Worker& worker);
  bool is_excluded(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
                   std::array<std::uint32_t, 4> vertices) const;
  void decide_open_pairs(std::uint32_t job, ElementPairKind kind, std::size_t count, Worker& worker);
  void limit_step(std::uint32_t job, ElementPairKind kind, const OpenPair& pair, Worker& worker);
  std::optional<double> limit_of(std::uint32_t job, ElementPairKind kind, const OpenPair& pair,
                                 Worker& worker);
  static bool limits_before(const StepLimit& p, const StepLimit& q);
  void start_steps(const PassInput& input, std::span<const MovingObject> objects,
                   const ImpactSearchOptions& options, const std::optional<StepOptions>& step);
  SafeStep first_in(SafeStep own, const FirstOfAll& first_of_all) const;
  void list_limits();
  void add_near(std::uint32_t job, ElementPairKind kind, const OpenPair& pair, bool touches, Worker& worker);
  /// Adds what the last search found to `near_`, in canonical order, and returns the indices there.
  std::vector<std::uint32_t> list_near();
  /// Adds the limits of these pairs that touch at the start: the start where they do not part, and otherwise
  /// when they touch again. With `failing`, the ways lead to the rounded positions at the steps of the
  /// islands, all pairs count, and it is the limit of those that touch there.
  void limit_near(std::span<const std::uint32_t> pairs, std::optional<double> failing,
                  const Parallel& parallel);
  void search_islands(std::span<const std::uint32_t> jobs, const Parallel& parallel);
  void limit_islands();
  void shorten(std::uint32_t island, const StepLimit& limit);
  void prove_rounded_positions(const FirstOfAll& first_of_all, const Parallel& parallel);
  bool moves(std::uint32_t object) const;
  std::uint32_t island_of(std::uint32_t object) const;
  std::uint32_t mover_of(std::uint32_t job) const;
  double longest_step(std::uint32_t job) const;
  bool is_between_islands(std::uint32_t job) const;
  void add_contact(std::uint32_t job, ElementPairKind kind, const OpenPair& pair, const Impact& impact,
                   Worker& worker);
  void keep_earlier(std::uint32_t job, const ContinuousContact& contact, Worker& worker);
  void shorten_search(std::uint32_t job, double time);
  std::atomic<float>& latest_of(std::uint32_t job) { return latest_[latest_of_job_[job]]; }
  const std::atomic<float>& latest_of(std::uint32_t job) const { return latest_[latest_of_job_[job]]; }
  static bool is_before(const ContinuousContact& p, const ContinuousContact& q);
  static std::uint64_t place_of(std::uint32_t job, const ContinuousContact& contact);
  bool lists_first() const { return options_.listing == ContinuousListing::first; }
  void keep_first(std::size_t first, std::size_t least, Worker& worker) const;
  void move_known() { outcomes_.move_known<0>(records_); }
  void gather_found(std::size_t outcome, Worker& worker, const Parallel& parallel);

  /// After so many attempts to reach rounded positions, elements that touch at the start end the step there.
  static constexpr int most_rounds = 8;

  Search search_ = Search::all;
  ImpactSearchOptions options_;
  std::optional<StepOptions> step_;      // nothing for the longest step
  ImpactSearchOptions last_options_;     // of the last `run`
  StepStats work_;                       // of the searches besides `run`
  std::vector<std::uint32_t> all_jobs_;  // of `find_earliest`
  // Safe steps: the first limit of each job, and by object the islands as a forest. Each object points to one
  // of its island with a smaller index, or to itself; then it has the island's step.
  std::vector<StepLimit> limits_, all_limits_;
  std::vector<NearPair> near_;
  std::vector<std::uint32_t> island_;
  std::vector<SafeStep> safe_;
  /// The search skips pairs that cannot touch before these times; and which of them is that of each job.
  std::vector<std::atomic<float>> latest_ = std::vector<std::atomic<float>>(1);
  std::vector<std::uint32_t> latest_of_job_;
  FirstContacts first_contacts_;
};

}  // namespace supple
