#include "workloads/query_tasks.hpp"

#include <algorithm>

#include "supple/error.hpp"
#include "workloads/random_numbers.hpp"

namespace supple::benchmarks {
namespace {

constexpr std::size_t queries = 100'000, points_for_inside = 1'000'000;

Vec3d in_single_precision(const Vec3d& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

struct Box {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};

  explicit Box(const DeformingCopies& copies) {
    for (std::size_t i = 0; i < copies.copies(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], double{copies.bounds(i).min[axis]});
        high[axis] = std::max(high[axis], double{copies.bounds(i).max[axis]});
      }
    }
  }
  Vec3d random_point(RandomNumbers& random) const {
    const double x = random.uniform(low.x, high.x), y = random.uniform(low.y, high.y);
    return in_single_precision({x, y, random.uniform(low.z, high.z)});
  }
};

}  // namespace

std::optional<QueryTask> make_query_task(const std::string& name) {
  const auto has = [&](const char* kind) { return name.starts_with(kind); };
  const auto after = [&](std::size_t length, std::size_t ending) {
    return name.substr(length, name.size() - length - ending);
  };
  const bool is_near = name.ends_with("-near"), is_deep = name.ends_with("-deep");
  std::string copies_name;
  QueryTaskKind kind = QueryTaskKind::closest;
  if (has("closest/") && (is_near || name.ends_with("-uniform"))) {
    copies_name = after(8, is_near ? 5 : 8) + "x1";
  } else if (has("inside/")) {
    kind = QueryTaskKind::inside;
    copies_name = after(7, 0) + "x1";
  } else if (has("rays/")) {
    kind = QueryTaskKind::rays;
    copies_name = after(5, 0);
  } else if (has("penetration/")) {
    kind = QueryTaskKind::penetration;
    copies_name = after(12, is_deep ? 5 : 0) + "x2";
  } else if (has("distance/") && (is_near || name.ends_with("-apart"))) {
    kind = QueryTaskKind::distance;
    copies_name = after(9, is_near ? 5 : 6) + "x1";
  } else {
    throw Error("no query task is named '" + name + "'");
  }
  auto copies = make_deforming_copies(copies_name);
  if (!copies) return {};
  if (is_deep) copies = DeformingCopies(copies->mesh(), 2, 0.4);
  QueryTask task{kind, std::move(*copies)};
  RandomNumbers random(7);
  const Box box(task.copies);
  const auto vertices = task.copies.positions(0);
  const double reach = 0.01 * (box.high.x - box.low.x);
  if (kind == QueryTaskKind::distance)
    task.offset = in_single_precision({(box.high.x - box.low.x) * (is_near ? 1.025 : 2), 0, 0});
  const bool has_queries = kind != QueryTaskKind::penetration && kind != QueryTaskKind::distance;
  const std::size_t count = kind == QueryTaskKind::inside ? points_for_inside : queries;
  for (std::size_t i = 0; i < count && has_queries; ++i) {
    if (kind == QueryTaskKind::rays) {
      const Vec3d origin = box.random_point(random);
      task.rays.push_back({origin, in_single_precision(random.direction())});
    } else if (is_near) {
      const Vec3f v = vertices[random.next() % vertices.size()];
      const Vec3d offset = random.direction() * (reach * random.uniform());
      task.points.push_back(in_single_precision(Vec3d{v.x, v.y, v.z} + offset));
    } else {
      task.points.push_back(box.random_point(random));
    }
  }
  return task;
}

}  // namespace supple::benchmarks
