// The first impact and safe steps: each rank searches its pairs, and all take what the first of them found.

#include <optional>

#include "distributed_implementation.hpp"

namespace supple {
namespace {

/// A safe step and the pair that ends it, as a contact at this time.
std::optional<ContinuousContact> as_contact(const SafeStep& safe) {
  if (!safe.limit) return std::nullopt;
  ContinuousContact contact{};
  contact.object_a = safe.limit->object_a;
  contact.object_b = safe.limit->object_b;
  contact.kind = safe.limit->kind;
  contact.element_a = safe.limit->element_a;
  contact.element_b = safe.limit->element_b;
  contact.toi = safe.step;
  return contact;
}

SafeStep as_step(const std::optional<ContinuousContact>& contact, bool stopped) {
  return contact ? SafeStep{contact->toi, pair_of_contact(*contact), stopped} : SafeStep{1, {}, stopped};
}

}  // namespace

/// Collective: the first in canonical order of those with the earliest time. `own` has the numbers of the
/// local world, what is returned those of the user.
std::optional<ContinuousContact> DistributedScene::Implementation::first_of_all(
    const std::optional<ContinuousContact>& own) {
  constexpr double never = 2;
  static const RecordInfo record = record_info<ContinuousContact>();
  std::vector<double> latest{own ? -own->toi : -never};
  ranks.largest(latest);
  const double earliest = -latest[0];
  if (earliest == never) return std::nullopt;
  outbox_.clear();
  if (own && own->toi == earliest) outbox_.to(0).put(renumbered(*own, local_));
  ranks.exchange(outbox_, inbox_);
  ContinuousContact first{};
  bool is_first = true;
  const auto bytes = [](const ContinuousContact& contact) {
    return reinterpret_cast<const std::byte*>(&contact);
  };
  inbox_.for_each([&](Reader& from, int) {
    const auto other = from.get<ContinuousContact>();
    if (is_first || is_before(record, bytes(other), bytes(first))) first = other;
    is_first = false;
  });
  MPI_Bcast(&first, sizeof first, MPI_BYTE, 0, ranks.handle());
  return first;
}

std::optional<ContinuousContact> DistributedScene::Implementation::earliest_impact(const StepLimits& limits) {
  ranks.begin([&] {
    check_limits(limits, "earliest_impact");
    return call("earliest_impact");
  });
  const SceneOptions& of = options.scene;
  const ImpactSearchOptions search{of.impact, of.element_kinds, of.continuous_listing};
  question_ = {.contacts = ContactKinds::continuous, .impact = search};
  prepare();
  std::optional<ContinuousContact> own;
  bool is_stopped = false;
  ranks.together([&] {
    own = step_search_.earliest_impact(search, limits);
    is_stopped = stop_of(limits).stop_requested();
  });
  const std::optional<ContinuousContact> first = first_of_all(own);
  is_stopped = ranks.any(is_stopped);
  end_step();
  return is_stopped ? std::nullopt : first;
}

/// The longest step without `step`.
SafeStep DistributedScene::Implementation::safe_step(const std::optional<StepOptions>& step,
                                                     const StepLimits& limits) {
  ranks.begin([&] {
    const char* const name = step ? "collision_free_step" : "max_step";
    if (step) check(*step, name);
    check_limits(limits, name);
    return step ? call(name).add_options(*step) : call(name);
  });
  const SceneOptions& of = options.scene;
  const ImpactSearchOptions search{of.impact, of.element_kinds, of.continuous_listing};
  question_ = {.contacts = ContactKinds::continuous, .impact = search, .safe_step = step};
  prepare();
  SafeStep safe;
  ranks.together([&] {
    safe = step_search_.safe_step(search, step, limits, [&](const SafeStep& own) {
      ranks.together([] {});  // a rank that failed tells the others here
      const std::optional<ContinuousContact> first = first_of_all(as_contact(own));
      return as_step(first, ranks.any(own.stopped));
    });
  });
  end_step();
  return safe;
}

}  // namespace supple
