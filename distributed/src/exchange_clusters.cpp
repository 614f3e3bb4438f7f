// Which clusters a rank tests, and how it gets them.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "answers/object_pairs.hpp"
#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "distributed_implementation.hpp"
#include "geometry/aabb.hpp"

namespace supple {
namespace {

/// What a rank asks of the home of a cluster.
struct Request {
  ClusterName name;
  bool has_topology = false;
  std::uint64_t version = 0;  ///< of the positions that the rank has
  double work = 0;
};

/// What follows in an answer.
struct Answer {
  ClusterName name;
  std::int32_t owner = 0;
  std::uint64_t version = 0;
  bool has_topology = false, has_positions = false;
};

/// The center of a box, in the range where Zoltan's sums are finite.
Vec3d center(const Aabb& box) {
  constexpr double most = 1e37;
  Vec3d p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = std::clamp(0.5 * (double{box.min[axis]} + double{box.max[axis]}), -most, most);
  return std::isnan(p.x + p.y + p.z) ? Vec3d{} : p;
}

}  // namespace

/// Finds out which ranks have parts of each object. The rank `id.index % size` knows it for an id.
void DistributedScene::Implementation::agree_on_objects() {
  if (!ranks.any(has_changed_)) return;
  const auto directory_of = [&](ObjectId id) {
    return static_cast<int>(id.index % static_cast<std::uint32_t>(ranks.size()));
  };
  outbox_.clear();
  for (const auto& [id, object] : homes_) {
    Writer to = outbox_.to(directory_of(id));
    to.put(id);
    to.put(object.is_part());
    to.put(object.options.is_static);
    write_options(object.options, to);
  }
  ranks.exchange(outbox_, inbox_);
  struct Entry {
    std::vector<int> homes;
    bool is_part = false, is_static = false;
    std::vector<std::byte> options;
  };
  std::map<ObjectId, Entry> entries;
  ranks.together([&] {
    inbox_.for_each([&](Reader& from, int rank) {
      while (!from.is_done()) {
        const auto id = from.get<ObjectId>();
        Entry& entry = entries[id];
        const auto is_part = from.get<bool>(), is_static = from.get<bool>();
        const ObjectOptions object_options = read_options(from);
        std::vector<std::byte> bytes;
        Writer writer(bytes);
        write_options(object_options, writer);
        if (entry.homes.empty()) {
          entry = {{}, is_part, is_static, bytes};
        } else if (!is_part || !entry.is_part) {
          fail(object_options.name + " is on the ranks " + std::to_string(entry.homes.front()) + " and " +
               std::to_string(rank) + "; add it on one, or in parts with add_part");
        } else if (bytes != entry.options || is_static != entry.is_static) {
          fail(object_options.name + " has other options on rank " + std::to_string(rank) + " than on rank " +
               std::to_string(entry.homes.front()) + "; give all parts the same");
        }
        entry.homes.push_back(rank);
      }
    });
  });
  outbox_.clear();
  for (const auto& [id, entry] : entries) {
    for (const int rank : entry.homes) {
      Writer to = outbox_.to(rank);
      to.put(id);
      to.put(entry.homes.front());
      to.put(is_wide(entry.homes));
      to.put_all(rank == entry.homes.front() ? entry.homes : std::vector<int>());
    }
  }
  ranks.exchange(outbox_, inbox_);
  has_parts_ = false;
  inbox_.for_each([&](Reader& from, int) {
    while (!from.is_done()) {
      HomeObject& object = homes_.at(from.get<ObjectId>());
      object.first_home = from.get<int>();
      object.is_wide = from.get<bool>();
      object.homes = from.get_all<int>();
      has_parts_ = has_parts_ || object.is_part();
    }
  });
  has_parts_ = ranks.any(has_parts_);
  has_changed_ = false;
  most_imbalance_ = 0;
}

/// Divides space when objects changed or the last step was unbalanced.
void DistributedScene::Implementation::divide_space() {
  stats.divided = false;
  if (regions_.are_divided() && stats.imbalance <= most_imbalance_) return;
  std::vector<WeightedPoint> points;
  for (const auto& [id, object] : homes_) {
    for (const Cluster& cluster : object.clusters) {
      if (!cluster.box.empty()) points.push_back({center(cluster.box), cluster.work});
    }
  }
  if (!ranks.any(!points.empty())) return;
  regions_.divide(points);
  region_ = regions_.own();
  stats.divided = true;
}

void DistributedScene::Implementation::send_unit(const Unit& unit, const std::vector<int>& homes) {
  if (unit.box.empty()) return;
  const auto put = [&](Writer to) {
    to.put(unit);
    to.put_all(homes);
  };
  const std::span<const int> meets = regions_.ranks_of(unit.box);
  if (is_wide(meets)) return put(Writer(to_all_));
  for (const int rank : meets) put(outbox_.to(rank));
}

/// Sends the boxes of clusters, and those of whole objects from their first homes, grown for the search.
void DistributedScene::Implementation::send_units() {
  outbox_.clear();
  to_all_.clear();
  stats.clusters = 0;
  for (auto& [id, object] : homes_) {
    const ObjectOptions& of = object.options;
    const double growth = growth_ + (question_.safe_step ? 0 : growth_of(of, nullptr, question_));
    Unit unit{{id, ranks.rank(), object.addition, all_clusters},
              grown(object.box, growth),
              0,
              of.group,
              of.mask,
              of.is_static,
              of.self_collision};
    if (!object.homes.empty()) send_unit(unit, object.homes);
    stats.clusters += object.clusters.size();
    for (std::uint32_t c = 0; c < object.clusters.size() && !by_objects_; ++c) {
      const Cluster& cluster = object.clusters[c];
      unit.name.cluster = c;
      if (question_.safe_step) {
        const VertexWays ways = object.ways_of(cluster);
        unit.box = grown(cluster.box, growth_of(of, &ways, question_));
      } else {
        unit.box = grown(cluster.box, growth);
      }
      unit.triangles = static_cast<std::uint32_t>(cluster.elements.size());
      send_unit(unit, {});
    }
  }
}

void DistributedScene::Implementation::read_units(const Inbox& wide) {
  objects_.clear();
  clusters_.clear();
  homes_of_.clear();
  for (const Inbox* const units : {&std::as_const(inbox_), &wide}) {
    units->for_each([&](Reader& from, int) {
      while (!from.is_done()) {
        const auto unit = from.get<Unit>();
        std::vector<int> homes = from.get_all<int>();
        if (!region_.meets(unit.box)) continue;
        (unit.name.cluster == all_clusters ? objects_ : clusters_).push_back(unit);
        if (unit.name.cluster == all_clusters) homes_of_[unit.name.object] = std::move(homes);
      }
    });
  }
  for (auto* const units : {&objects_, &clusters_})
    std::sort(units->begin(), units->end(), [](const Unit& p, const Unit& q) { return p.name < q.name; });
}

/// Whether the pair filter lets the objects through; it is asked once for each pair.
bool DistributedScene::Implementation::accepts(const Unit& a, const Unit& b) {
  if (!filter_ || a.name.object == b.name.object) return true;
  const auto [p, q] = std::minmax(a.name.object, b.name.object);
  const auto [known, is_new] = filtered_.try_emplace({p, q}, false);
  if (is_new) known->second = filter_(p, q);
  return known->second;
}

/// The pairs of objects of this rank. When whole objects are tested, it needs all their clusters.
void DistributedScene::Implementation::find_object_pairs() {
  std::vector<Aabb> boxes;
  for (const Unit& unit : objects_) boxes.push_back(unit.box);
  // By the lower corner, so that one rank has each pair.
  const auto owns = [&](const Aabb& box) { return region_.contains(Vec3d{box.min.x, box.min.y, box.min.z}); };
  object_pairs_.clear();
  filtered_.clear();
  for (const auto& [i, j] : object_phase_.find_object_pairs(boxes)) {
    const Unit &a = objects_[i], &b = objects_[j];
    if (a.may_pair(b) && owns(shared_box(a.box, b.box)) && accepts(a, b))
      object_pairs_.push_back({a.name.object, b.name.object});
  }
  tested_.clear();
  needed_.clear();
  if (!by_objects_) return;
  tested_ = object_pairs_;
  for (const Unit& unit : objects_) {
    if (unit.self_collision && owns(unit.box)) tested_.push_back({unit.name.object, unit.name.object});
  }
  for (const auto& [a, b] : tested_) {
    for (const ObjectId id : {a, b}) {
      for (const int home : homes_of_.at(id)) needed_.push_back({{id, home, 0, all_clusters}, 0});
    }
  }
  sort_once(needed_);
  sort_once(tested_);
}

/// The pairs of clusters whose boxes meet in the region of this rank, which needs both.
void DistributedScene::Implementation::find_cluster_pairs() {
  stats.cluster_pairs = 0;
  if (by_objects_) return;
  std::vector<Aabb> boxes;
  for (const Unit& unit : clusters_) boxes.push_back(unit.box);
  std::vector<double> work(clusters_.size(), 0);
  const auto need = [&](std::size_t i, std::size_t j) {
    const Unit &a = clusters_[i], &b = clusters_[j];
    ++stats.cluster_pairs;
    tested_.push_back({a.name.object, b.name.object});
    const double half = 0.25 * (double{1} * a.triangles + b.triangles);
    work[i] += half;
    work[j] += half;
  };
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    if (clusters_[i].self_collision) need(i, i);
  }
  for (const auto& [i, j] : cluster_phase_.find_object_pairs(boxes)) {
    const Unit &a = clusters_[i], &b = clusters_[j];
    if (a.may_pair(b) && region_.meets(shared_box(a.box, b.box)) && accepts(a, b)) need(i, j);
  }
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    if (work[i] > 0) needed_.push_back({clusters_[i].name, work[i]});
  }
  sort_once(tested_);
}

void DistributedScene::Implementation::request_clusters() {
  outbox_.clear();
  for (const auto& [name, work] : needed_) {
    if (name.home == ranks.rank()) continue;  // `take_clusters` takes it
    Writer to = outbox_.to(name.home);
    const auto version = local_.version_of(name);
    to.put(Request{name, version.has_value(), version.value_or(0), work});
    if (name.cluster != all_clusters) continue;
    std::vector<Request> known;
    local_.for_each_known(name.object, name.home,
                          [&](const ClusterName& cluster, std::uint64_t of_positions) {
                            known.push_back({cluster, true, of_positions, 0});
                          });
    to.put_all(known);
  }
}

void DistributedScene::Implementation::answer_requests() {
  outbox_.clear();
  for (auto& [id, object] : homes_) {
    for (Cluster& cluster : object.clusters) {
      if (!by_objects_) cluster.work = static_cast<double>(cluster.elements.size());
    }
  }
  inbox_.for_each([&](Reader& from, int rank) {
    Writer to = outbox_.to(rank);
    const auto answer = [&](const HomeObject& object, std::uint32_t cluster, bool has_topology,
                            std::uint64_t version) {
      to.put(Answer{{object.id, ranks.rank(), object.addition, cluster},
                    object.first_home,
                    object.version(),
                    !has_topology,
                    version != object.version()});
      if (!has_topology) {
        write_options(object.options, to);
        object.write_topology(cluster, to);
      }
      if (version != object.version()) object.write_positions(cluster, to);
    };
    while (!from.is_done()) {
      const auto request = from.get<Request>();
      HomeObject& object = homes_.at(request.name.object);
      if (request.name.cluster != all_clusters) {
        object.clusters[request.name.cluster].work += request.work;
        answer(object, request.name.cluster, request.has_topology, request.version);
        continue;
      }
      const auto known = from.get_all<Request>();
      for (std::uint32_t c = 0; c < object.clusters.size(); ++c) {
        const auto found = std::find_if(known.begin(), known.end(), [&](const Request& r) {
          return r.name.cluster == c && r.name.addition == object.addition;
        });
        const bool has_topology = found != known.end();
        answer(object, c, has_topology, has_topology ? found->version : 0);
      }
    }
  });
}

void DistributedScene::Implementation::take_clusters() {
  owners_.clear();
  local_.begin();
  for (auto [name, work] : needed_) {
    if (name.home != ranks.rank()) continue;
    HomeObject& object = homes_.at(name.object);
    owners_[name.object] = object.first_home;
    name.addition = object.addition;
    if (name.cluster != all_clusters) {
      object.clusters[name.cluster].work += work;
      local_.take_own(name, object);
      continue;
    }
    for (name.cluster = 0; name.cluster < object.clusters.size(); ++name.cluster)
      local_.take_own(name, object);
  }
  inbox_.for_each([&](Reader& from, int) {
    while (!from.is_done()) {
      const auto answer = from.get<Answer>();
      owners_[answer.name.object] = answer.owner;
      local_.read_cluster(answer.name, answer.version, answer.has_topology, answer.has_positions, from);
    }
  });
  local_.end(by_objects_);
  stats.triangles = local_.needed_triangles();
}

bool DistributedScene::Implementation::is_tested(ObjectId a, ObjectId b) const {
  return std::binary_search(tested_.begin(), tested_.end(), ObjectPair{user(a), user(b)});
}

/// Brings the units of this step to the ranks whose regions they meet.
void DistributedScene::Implementation::exchange_units() {
  has_detected_ = false;
  Inbox wide;
  ranks.bytes_sent = ranks.messages_sent = 0;
  agree_on_objects();
  ranks.together([&] {
    for (auto& [id, object] : homes_) object.update_boxes(question_.shapes(), world().parallel);
  });
  if (has_parts_) {
    outbox_.clear();
    to_all_.clear();
    for (const auto& [id, object] : homes_) {
      if (object.first_home == ranks.rank()) continue;
      Writer to = object.is_wide ? Writer(to_all_) : outbox_.to(object.first_home);
      to.put(id);
      to.put(object.box);
    }
    ranks.exchange(outbox_, inbox_);
    ranks.share(to_all_, wide);
    for (const Inbox* const boxes : {&std::as_const(inbox_), &std::as_const(wide)}) {
      boxes->for_each([&](Reader& from, int) {
        while (!from.is_done()) {
          const auto home = homes_.find(from.get<ObjectId>());
          const auto box = from.get<Aabb>();
          if (home != homes_.end() && home->second.first_home == ranks.rank()) extend(home->second.box, box);
        }
      });
    }
  }
  divide_space();
  ranks.together([&] { send_units(); });
  ranks.exchange(outbox_, inbox_);
  ranks.share(to_all_, wide);
  ranks.together([&] { read_units(wide); });
}

/// Brings the clusters that this rank needs into its world.
void DistributedScene::Implementation::fetch_clusters() {
  ranks.together([&] { request_clusters(); });
  ranks.exchange(outbox_, inbox_);
  ranks.together([&] { answer_requests(); });
  ranks.exchange(outbox_, inbox_);
  ranks.together([&] {
    try {
      take_clusters();
    } catch (...) {
      local_.forget();  // it has clusters that are not in their places
      throw;
    }
    world().set_filter([this](ObjectId a, ObjectId b) { return is_tested(a, b); });
    for (const auto id : world().objects()) world().set_options(id, {.self_collision = is_tested(id, id)});
  });
  release_messages();  // the search needs the memory
}

/// Brings all that this rank tests into its world: whole objects, or clusters. Boxes grow by `growth` besides
/// what the question needs.
void DistributedScene::Implementation::prepare(bool by_objects, double growth) {
  by_objects_ = by_objects;
  growth_ = growth;
  exchange_units();
  ranks.together([&] {
    find_object_pairs();
    find_cluster_pairs();
  });
  fetch_clusters();
}

}  // namespace supple
