#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "answers/impact/impact_pass.hpp"
#include "answers/intersection/intersection_pass.hpp"
#include "answers/moving_objects.hpp"
#include "answers/object_pairs.hpp"
#include "answers/penetration/penetration_pass.hpp"
#include "answers/proximity/proximity_pass.hpp"
#include "answers/question.hpp"
#include "answers/untested.hpp"
#include "core/stop_signal.hpp"
#include "world/world.hpp"

namespace supple {

/// One search for all contacts in a world: what `Scene::detect` finds, without events. Several of them can
/// search the same world. Each keeps its answers and its memory until it runs again.
class Detection {
 public:
  explicit Detection(World& world) : world_(world), pairs_(world) {}

  /// Returns false when it was stopped; then there are no answers.
  bool run(const Question& question, std::uint64_t max_contacts, const StopSignal& stop, StepStats& stats);
  /// Adds the answers to `found`; the spans are valid until the next run.
  void list(DetectResult& found);

  /// Calls `visit(list)` for each list to which `list` adds spans.
  template <class Visit>
  void visit_lists(const Visit& visit) {
    pairs_.visit_lists(visit);
    std::apply([&](auto&... pass) { (pass.visit_lists(visit), ...); }, passes_);
    untested_.visit_lists(visit);
    visit(non_finite_);
  }

  /// Those of the last run.
  const Question& question() const { return question_; }
  const ObjectPairs& pairs() const { return pairs_; }

 private:
  template <class Kind>
  bool find(Kind& pass, const PassInput& input, DetectResult& found, StepStats& stats);
  void list_objects(ContactKinds kind, std::vector<IntersectedObject>& objects);
  void list_objects(ContactKinds kind, std::vector<MovingObject>& objects);
  void list_objects(ContactKinds kind, std::vector<PenetratedObject>& objects);
  void list_non_finite();

  World& world_;
  Question question_;
  ObjectPairs pairs_;
  std::vector<NodePair> node_pairs_;  // scratch memory of lazy shapes
  std::vector<ChildPair> children_;
  // One for each kind of contacts; penetration reads the intersections.
  std::tuple<IntersectionPass, ImpactPass, ProximityPass, PenetrationPass> passes_;
  UntestedKinds untested_;
  std::vector<NonFiniteVertex> non_finite_;
  // By slot; those of the jobs, and all moving objects.
  std::tuple<std::vector<IntersectedObject>, std::vector<MovingObject>, std::vector<PenetratedObject>>
      objects_;
  std::vector<std::uint8_t> is_listed_;
};

}  // namespace supple
