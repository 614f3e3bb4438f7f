// Brute force over the whole scene. Each rank takes all objects from their homes and all that was found, so
// neither clusters nor regions take part, and tests every so many pairs of objects.

#include "verify/verify.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "distributed_implementation.hpp"
#include "supple/difference_descriptions.hpp"

namespace supple {
namespace {

/// The user's numbers of an object.
struct NumbersOfObject {
  ObjectId object;
  std::vector<std::uint32_t> faces, vertices;  ///< ascending
};

/// All objects, in the order of their ids, with numbers from 0.
class WholeScene {
 public:
  explicit WholeScene(const SceneOptions& options) : world_(options) {}

  void add(ObjectId id, const SavedObject& saved);
  void set_filter(const PairFilter& filter);
  const World& world() const { return world_; }

  /// The numbers here of the user's.
  struct Own final : Numbers {
    explicit Own(const WholeScene& of) : scene(of) {}
    const WholeScene& scene;

    ObjectId object(ObjectId id) const override { return scene.world_.id_of(scene.slots_.at(id)); }
    std::uint32_t face(ObjectId id, std::uint32_t t) const override { return place(numbers(id).faces, t); }
    std::uint32_t vertex(ObjectId id, std::uint32_t v) const override {
      return place(numbers(id).vertices, v);
    }

   private:
    const NumbersOfObject& numbers(ObjectId id) const { return scene.numbers_[scene.slots_.at(id)]; }
    static std::uint32_t place(const std::vector<std::uint32_t>& numbers, std::uint32_t number) {
      const auto found = std::lower_bound(numbers.begin(), numbers.end(), number);
      if (found == numbers.end() || *found != number) fail("verify: a contact has elements of no object");
      return static_cast<std::uint32_t>(found - numbers.begin());
    }
  };

  /// The user's numbers of those here.
  struct Users final : Numbers {
    explicit Users(const WholeScene& of) : scene(of) {}
    const WholeScene& scene;

    ObjectId object(ObjectId own) const override { return scene.numbers_[own.index].object; }
    std::uint32_t face(ObjectId own, std::uint32_t t) const override {
      return scene.numbers_[own.index].faces[t];
    }
    std::uint32_t vertex(ObjectId own, std::uint32_t v) const override {
      return scene.numbers_[own.index].vertices[v];
    }
  };

 private:
  World world_;
  std::vector<NumbersOfObject> numbers_;  // by slot
  std::map<ObjectId, std::uint32_t> slots_;
};

void WholeScene::add(ObjectId id, const SavedObject& saved) {
  ObjectOptions options = saved.options;
  options.is_static = false;  // until it has its motion
  saved.visit_positions([&](const PositionsView& start, const PositionsView& end) {
    const ObjectId own = world_.add(end, saved.triangles, options, "");
    if (saved.has_motion) world_.set_motion(own, start, end);
    world_.set_vertex_groups(own, saved.groups, saved.masks);
    world_.set_options(own, {.is_static = saved.options.is_static});
    slots_.emplace(id, own.index);
  });
  numbers_.push_back({id, saved.faces, saved.vertices});
}

void WholeScene::set_filter(const PairFilter& filter) {
  if (!filter) return;
  world_.set_filter([this, &filter](ObjectId a, ObjectId b) {
    return filter(numbers_[a.index].object, numbers_[b.index].object);
  });
}

/// Calls `visit(member)` for each list of differences.
template <class Visit>
void for_each_differences(const Visit& visit) {
  visit(&VerifyReport::differences);
  visit(&VerifyReport::continuous_differences);
  visit(&VerifyReport::proximity_differences);
  visit(&VerifyReport::penetration_differences);
}

/// All differences of two objects are from one rank, in their order, which stays.
template <class Record>
void sort_by_pairs(std::vector<Record>& records) {
  std::map<std::pair<ObjectId, ObjectId>, std::vector<Record>> by_pair;
  for (const Record& record : records)
    by_pair[std::minmax(record.object_a, record.object_b)].push_back(record);
  std::size_t next = 0;
  for (const auto& [pair, of_pair] : by_pair) {
    for (const Record& record : of_pair) records[next++] = record;
  }
}

template <class Visit>
void for_each_count(const Visit& visit) {
  for (const auto count : {&VerifyReport::triangle_pairs_checked, &VerifyReport::intersecting_pairs,
                           &VerifyReport::element_pairs_checked, &VerifyReport::touching_element_pairs,
                           &VerifyReport::proximity_pairs_checked, &VerifyReport::near_pairs,
                           &VerifyReport::vertex_triangle_pairs_checked, &VerifyReport::inside_vertices})
    visit(count);
}

}  // namespace

VerifyReport DistributedScene::Implementation::verify(const CallLimits& limits) {
  ranks.begin([&] {
    if (!has_detected_)
      fail("verify: nothing was detected at the present positions; call detect directly before it");
    if (question_.contacts == ContactKinds::none)
      fail("verify: the last detect searched no contacts, so there is nothing to compare");
    return call("verify");
  });
  ranks.together([&] {
    to_all_.clear();
    Writer to(to_all_);
    to.put<std::uint64_t>(homes_.size());
    for (const auto& [id, home] : homes_) {
      std::vector<std::byte> bytes;
      Writer writer(bytes);
      home.write(writer);
      to.put(id);
      to.put_all(bytes);
    }
    lists_.write(to);
  });
  ranks.share(to_all_, inbox_);
  VerifyReport report;
  ranks.together([&] {
    std::map<ObjectId, std::vector<std::span<const std::byte>>> parts;
    FoundLists found;
    inbox_.for_each([&](Reader& from, int) {
      for (auto count = from.get<std::uint64_t>(); count > 0; --count) {
        const auto id = from.get<ObjectId>();
        parts[id].push_back(from.bytes_of_all<std::byte>());
      }
      found.append(from);
    });
    WholeScene scene(options.scene);
    for (const auto& [id, of_object] : parts) scene.add(id, read_object(of_object));
    scene.set_filter(filter_);
    found.renumber(WholeScene::Own(scene));
    found.sort();
    DetectResult result;
    found.list(result);
    report = supple::verify(scene.world(), question_, result, limits,
                            {static_cast<std::size_t>(ranks.rank()), static_cast<std::size_t>(ranks.size())});
    to_all_.clear();
    Writer to(to_all_);
    for_each_count([&](auto count) { to.put(report.*count); });
    to.put(report.stopped);
    for_each_differences([&](auto differences) {
      for (auto& difference : report.*differences)
        difference = renumbered(difference, WholeScene::Users(scene));
      to.put_all(report.*differences);
    });
  });
  ranks.share(to_all_, inbox_);
  ranks.together([&] {
    report = {};
    inbox_.for_each([&](Reader& from, int) {
      for_each_count([&](auto count) { report.*count += from.get<std::uint64_t>(); });
      report.stopped = from.get<bool>() || report.stopped;
      for_each_differences([&](auto differences) { from.append_all(report.*differences); });
    });
    for_each_differences([&](auto differences) { sort_by_pairs(report.*differences); });
  });
  return report;
}

}  // namespace supple
