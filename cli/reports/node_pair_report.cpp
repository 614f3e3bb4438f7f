#include "reports/reports.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <ranges>
#include <span>

#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "supple/inspection.hpp"

namespace supple::cli {
namespace {

NodePairList node_pairs_of(const Scene& scene, ObjectNumbers objects) {
  const std::vector<ObjectId> ids = scene.objects();
  return SceneInspector(scene).node_pairs(ids[objects[0]], ids[objects[1]]);
}

/// `A(9, 2)`, or `S(9, 2)` for a sphere, as in the paper.
std::string name_of(const OctreeCell& node) {
  return fmt::format("{}({}, {})", node.sphere.empty() ? 'A' : 'S',
                     node.number ? fmt::format("{}", *node.number) : "?", node.number_level);
}

std::string names_of(const NodePairList& list, std::span<const NodePairList::Pair> pairs) {
  constexpr std::size_t most = 4;
  std::string text;
  for (const NodePairList::Pair& pair : pairs.first(std::min(most, pairs.size())))
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name_of(list.nodes_a[pair.a]),
                        name_of(list.nodes_b[pair.b]));
  if (pairs.size() > most) text += fmt::format(" and {} more", grouped(pairs.size() - most));
  return text;
}

}  // namespace

void check_node_pairs(const Input& input, ObjectNumbers objects) {
  for (const std::uint32_t object : objects) {
    if (object >= input.objects.size())
      fail("--node-pairs: there is no object {}; there are {}, numbered from 0", object,
           input.objects.size());
  }
  if (objects[0] == objects[1] && !input.objects[objects[0]].options.self_collision)
    fail("--node-pairs: object {} is not tested against itself; add --self", objects[0]);
}

void print_node_pairs(const Scene& scene, ObjectNumbers objects, std::uint64_t frame) {
  const std::vector<ObjectId> ids = scene.objects();
  const NodePairList list = node_pairs_of(scene, objects);
  fmt::print("\nnarrow phase of {} and {} in frame {}: ", name_of(scene, ids[objects[0]]),
             name_of(scene, ids[objects[1]]), frame);
  if (list.level_count() == 0) {
    fmt::print("the broad phase does not report this pair\n");
    return;
  }
  fmt::print("pairs of nodes (h, k) that collide, by level\n");
  fmt::print("{:>5} {:>12} {:>12}   {}\n", "level", "pairs", "of leaves", "nodes");
  for (std::uint32_t level = 0; level < list.level_count(); ++level) {
    const auto pairs = list.pairs_of(level);
    const auto leaves = std::count_if(
        pairs.begin(), pairs.end(), [&](const NodePairList::Pair& pair) { return list.is_leaf_pair(pair); });
    fmt::print("{:>5} {:>12} {:>12}   {}\n", level, grouped(pairs.size()),
               grouped(static_cast<std::uint64_t>(leaves)), names_of(list, pairs));
  }
}

void write_node_pairs(JsonWriter& json, const Scene& scene, ObjectNumbers objects) {
  const NodePairList list = node_pairs_of(scene, objects);
  const auto write_node = [&](const OctreeCell* node) {
    json.begin_array();
    node->number ? json.value(*node->number) : json.null();
    json.value(node->number_level);
    json.end_array();
  };
  const auto write_pair = [&](const NodePairList::Pair& pair) {
    json.array(std::array{&list.nodes_a[pair.a], &list.nodes_b[pair.b]}, write_node);
  };
  json.object("node_pairs", [&] {
    json.member("a", objects[0]);
    json.member("b", objects[1]);
    json.list("levels", std::views::iota(0u, list.level_count()),
              [&](std::uint32_t level) { json.array(list.pairs_of(level), write_pair); });
  });
}

}  // namespace supple::cli
