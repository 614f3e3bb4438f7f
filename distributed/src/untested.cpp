// The kinds of contacts that had nothing to test. Most steps only need to know that two objects may touch,
// which the settings of all objects tell. Otherwise the first home of each object gets it whole, and rank 0
// decides.

#include "answers/untested.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "core/sort_once.hpp"
#include "distributed_implementation.hpp"

namespace supple {

/// Collective: whether two objects on any ranks may touch, at least by what each home knows of its part. Two
/// objects stand for all that have the same settings.
bool DistributedScene::Implementation::has_pair_to_test(ContactKinds kind) {
  outbox_.clear();
  ranks.together([&] {
    std::map<std::array<std::uint32_t, 5>, int> sent;
    for (const auto& [id, object] : homes_) {
      if (object.first_home != ranks.rank()) continue;
      const ObjectOptions& of = object.options;
      const TestableObject testable{.id = id,
                                    .takes_part = object.has_finite_face(),
                                    .has_quality = has_quality(kind, of, object.has_motion()),
                                    .is_static = of.is_static,
                                    .group = of.group,
                                    .mask = of.mask};
      if (sent[{testable.takes_part, testable.has_quality, of.is_static, of.group, of.mask}]++ < 2)
        outbox_.to(0).put(testable);
    }
  });
  ranks.exchange(outbox_, inbox_);
  bool has_pair = false;
  TestableObjects objects;
  inbox_.for_each([&](Reader& from, int) {
    while (!from.is_done())
      has_pair = objects.add(from.get<TestableObject>(), [](ObjectId, ObjectId) { return true; }) || has_pair;
  });
  return ranks.any(has_pair) && !ranks.any(static_cast<bool>(filter_));
}

/// What this rank knows of an object that it has whole.
TestableObject DistributedScene::Implementation::testable(ContactKinds kind, const HomeObject& object) {
  TestableObject found{.id = object.id};
  if (const auto local = local_.local_object(object.id)) {
    found = testable_object(kind, question_.impact.kinds, world()[local->index], object.id,
                            object.options.self_collision);
  }
  // The world has no static objects, and solids only where a search needs them.
  found.is_static = object.options.is_static;
  if (kind == ContactKinds::penetration) found.has_quality = object.options.solid;
  return found;
}

/// Collective: the requested kinds that found nothing and had nothing to test; the same on all ranks.
void DistributedScene::Implementation::list_untested() {
  untested_.clear();
  std::vector<double> are_found;
  for (const ContactKindInfo& of : contact_kinds) are_found.push_back(of.is_in(result_) ? 1 : 0);
  ranks.largest(are_found);
  std::vector<ContactKinds> open;
  for (std::size_t k = 0; k < contact_kinds.size(); ++k) {
    const ContactKinds kind = contact_kinds[k].kind;
    if (contains(question_.contacts, kind) && are_found[k] == 0 && !has_pair_to_test(kind))
      open.push_back(kind);
  }
  if (open.empty()) return;
  by_objects_ = true;
  needed_.clear();
  tested_.clear();
  for (const auto& [id, object] : homes_) {
    for (const int home : object.homes) needed_.push_back({{id, home, 0, all_clusters}, 0});
  }
  sort_once(needed_);
  fetch_clusters();
  for (const ContactKinds kind : open) {
    outbox_.clear();
    ranks.together([&] {
      for (const auto& [id, object] : homes_) {
        if (object.first_home == ranks.rank()) outbox_.to(0).put(testable(kind, object));
      }
    });
    ranks.exchange(outbox_, inbox_);
    int reason = -1;
    ranks.together([&] {
      std::vector<TestableObject> objects;
      inbox_.for_each([&](Reader& from, int) {
        while (!from.is_done()) objects.push_back(from.get<TestableObject>());
      });
      std::sort(objects.begin(), objects.end(),
                [](const TestableObject& p, const TestableObject& q) { return p.id < q.id; });
      if (ranks.rank() != 0) return;
      TestableObjects tested;
      const auto accept = [&](ObjectId a, ObjectId b) { return !filter_ || filter_(a, b); };
      for (const TestableObject& object : objects) {
        if (tested.add(object, accept)) return;
      }
      if (const auto found = tested.reason(kind)) reason = static_cast<int>(*found);
    });
    MPI_Bcast(&reason, 1, MPI_INT, 0, ranks.handle());
    if (reason >= 0) untested_.push_back({kind, static_cast<NothingToTest>(reason)});
  }
}

}  // namespace supple
