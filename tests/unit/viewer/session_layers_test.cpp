#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "../../support/random.hpp"
#include "../../support/scenes.hpp"
#include "../../support/viewer_page.hpp"
#include "supple/inspection.hpp"

namespace supple::viewer::session_layers_test {

/// Balls that touch or nearly touch. One of them waves, and one has self-collision.
SceneView crowd(BoundingVolume volume = BoundingVolume::aabb) {
  SceneView show;
  show.simulation.scene.bounding_volume = volume;
  show.simulation.scene.broad_phase = BroadPhaseMethod::octree;  // this method has regions
  for (int i = 0; i < 6; ++i)
    show.objects.push_back(
        test_ball(("ball " + std::to_string(i)).c_str(), {1.7 * (i % 3), 1.8 * (i / 3), 0.1 * i}, 6));
  show.objects[1].motion = WaveMotion{.velocity = {0.2, -0.1, 0.3}, .amplitude = 0.1};
  show.objects[2].options.self_collision = true;
  show.objects[4].options.is_static = show.objects[5].options.is_static = true;
  return show;
}

Row row(const std::array<Vec3f, 1>& a, float w, Vec3f b, float v) {
  return {a[0].x, a[0].y, a[0].z, w, b.x, b.y, b.z, v};
}

Vec3d wide(Vec3f p) {
  return {p.x, p.y, p.z};
}

Vec3f narrow(Vec3f p, Vec3d center) {
  return as_floats(std::array{wide(p)}, center)[0];
}

/// The shapes of cells, and the tags of the two layers of cells for each shape.
enum CellTag : std::uint32_t { box_tag, sphere_tag, edge_tag };
constexpr std::uint32_t octree_tags[] = {40, 41, 52}, colliding_tags[] = {50, 51, 53};

CellTag tag_of(BoundingVolume volume) {
  if (volume == BoundingVolume::aabb) return box_tag;
  return volume == BoundingVolume::sphere ? sphere_tag : edge_tag;
}

/// Adds what the page draws of a cell: its box, its sphere, or the edges of its oriented box or k-DOP.
void add_rows(const OctreeCell& cell, Vec3d center, std::vector<Row>& rows) {
  const float at = static_cast<float>(cell.level);
  const float triangles = cell.is_leaf ? static_cast<float>(cell.triangle_count) : -1;
  if (!cell.sphere.empty()) {
    rows.push_back(row({narrow(cell.sphere.center, center)}, cell.sphere.radius, {at, triangles, 0}, 0));
  } else if (cell.slabs.empty()) {
    rows.push_back(row({narrow(cell.box.min, center)}, at, narrow(cell.box.max, center), triangles));
  } else {
    for (const auto& edge : edges_of(cell.slabs)) {
      const std::vector<Vec3f> ends = as_floats(edge, center);
      rows.push_back(row({ends[0]}, at, ends[1], triangles));
    }
  }
}

TEST(ViewerLayers, AreLeftOutUntilAskedForAndAgainAfterwards) {
  TestPage page(crowd());
  page.scene();
  const auto has_layers = [](const ViewerMessage& frame) {
    return frame.has(38) || frame.has(39) || frame.has(40, 0) || frame.has(41, 0) || frame.has(42, 0);
  };
  EXPECT_FALSE(has_layers(page.frame()));
  page.ask({{"do", "layers"},
            {"candidates", true},
            {"scene_regions", true},
            {"colliding_vertices", true},
            {"octree", {{"objects", {3, 0, 3}}, {"level", 1}}}});
  const ViewerMessage frame = page.frame();
  EXPECT_TRUE(frame.has(38) && frame.has(39) && frame.has(40, 0) && frame.has(40, 3) && frame.has(42, 0));
  EXPECT_FALSE(frame.has(40, 1));
  page.ask({{"do", "layers"}, {"candidates", false}});  // layers that are not named stay the same
  const ViewerMessage fewer = page.frame();
  EXPECT_FALSE(fewer.has(38));
  EXPECT_TRUE(fewer.has(39) && fewer.has(40, 3));
  page.ask({{"do", "layers"}, {"scene_regions", false}, {"colliding_vertices", false}, {"octree", nullptr}});
  EXPECT_FALSE(has_layers(page.frame()));
}

TEST(ViewerLayers, HaveNoRegionsUnlessTheOctreeRan) {
  SceneView show = crowd();
  show.simulation.scene.broad_phase = BroadPhaseMethod::grid;
  TestPage page(show);
  page.scene();
  page.ask({{"do", "layers"}, {"scene_regions", true}});
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.json["broad_phase_method"], "grid");
  EXPECT_TRUE(frame.values<Row>(39).empty());
}

TEST(ViewerLayers, AreWhatTheLibrarySays) {
  for (const BoundingVolume volume : all_bounding_volumes) {
    const SceneView show = crowd(volume);
    Simulation simulation = simulation_of(show);
    TestPage page(show);
    const Vec3d center = center_of(page.scene());
    const Scene& scene = simulation.scene();
    for (int step = 0; step < 12; ++step) {
      if (step > 0) simulation.step();
      const int level = step % 4 - 1;
      page.ask({{"do", "layers"},
                {"candidates", true},
                {"scene_regions", true},
                {"octree", {{"objects", {0, 1, 2, 3, 4, 5}}, {"level", level}}}});
      const ViewerMessage frame = step == 0 ? page.frame() : page.frame_after_steps(1);

      std::vector<std::array<std::uint32_t, 4>> candidates;
      for (const CandidatePair& c : SceneInspector(scene).candidates(1'000'000).pairs)
        candidates.push_back({c.object_a.index, c.triangle_a, c.object_b.index, c.triangle_b});
      EXPECT_GT(candidates.size(), 0u);
      EXPECT_EQ((frame.values<std::array<std::uint32_t, 4>>(38)), candidates);

      std::vector<Row> regions;
      for (const SceneRegion& r : SceneInspector(scene).regions())
        regions.push_back(row({narrow(r.box.min, center)}, static_cast<float>(r.level),
                              narrow(r.box.max, center),
                              r.is_leaf ? static_cast<float>(r.object_count) : -1));
      EXPECT_FALSE(regions.empty());
      EXPECT_EQ(frame.values<Row>(39), regions);

      for (const ObjectId id : scene.objects()) {
        std::vector<Row> cells;
        const auto wanted = level < 0 ? std::nullopt : std::optional<std::uint32_t>(level);
        for (const OctreeCell& cell : SceneInspector(scene).cells(id, wanted)) add_rows(cell, center, cells);
        EXPECT_GT(cells.size(), 0u);
        EXPECT_EQ(frame.values<Row>(octree_tags[tag_of(volume)], id.index), cells) << name_of(volume);
        EXPECT_EQ(frame.json["octree_levels"][id.index], SceneInspector(scene).octree_depth(id));
      }
    }
  }
}

/// For each object, the rows of the nodes that are in a wanted pair, each once, by level and number.
std::vector<std::vector<Row>> colliding_rows(const Scene& scene, std::span<const ObjectPair> pairs, int level,
                                             Vec3d center) {
  using Name = std::pair<std::uint32_t, std::uint64_t>;
  std::vector<std::map<Name, OctreeCell>> nodes(scene.objects().size());
  for (const ObjectPair& pair : pairs) {
    const NodePairList list = SceneInspector(scene).node_pairs(pair.a, pair.b);
    for (std::uint32_t at = 0; at < list.level_count(); ++at) {
      for (const NodePairList::Pair& p : list.pairs_of(at)) {
        const OctreeCell &a = list.nodes_a[p.a], &b = list.nodes_b[p.b];
        const bool both_leaves = a.is_leaf && b.is_leaf;
        if (level == -1 ? !both_leaves : level >= 0 && static_cast<std::uint32_t>(level) != at) continue;
        nodes[pair.a.index].emplace(Name(a.level, *a.number), a);
        nodes[pair.b.index].emplace(Name(b.level, *b.number), b);
      }
    }
  }
  std::vector<std::vector<Row>> rows(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const auto& [name, cell] : nodes[i]) add_rows(cell, center, rows[i]);
  }
  return rows;
}

TEST(ViewerLayers, CollidingNodesAreThoseOfTheNarrowPhase) {
  for (const BoundingVolume volume : all_bounding_volumes) {
    const std::uint32_t tag = colliding_tags[tag_of(volume)];
    const SceneView show = crowd(volume);
    Simulation simulation = simulation_of(show);
    TestPage page(show);
    const Vec3d center = center_of(page.scene());
    const auto all_pairs = simulation.scene().result().object_pairs;
    const std::vector<ObjectPair> one{{{0, 0}, {1, 0}}};
    std::size_t most = 0;
    for (const int level : {-2, -1, 0, 1, 2}) {
      for (const std::span<const ObjectPair> pairs : {all_pairs, std::span<const ObjectPair>(one)}) {
        Json wanted{{"level", level}};
        if (pairs.data() == one.data()) wanted["objects"] = {0, 1};
        page.ask({{"do", "layers"}, {"colliding_nodes", wanted}});
        const ViewerMessage frame = page.frame();
        const auto expected = colliding_rows(simulation.scene(), pairs, level, center);
        for (std::uint32_t object = 0; object < expected.size(); ++object) {
          EXPECT_EQ(frame.has(tag, object), !expected[object].empty());
          if (expected[object].empty()) continue;
          EXPECT_EQ(frame.values<Row>(tag, object), expected[object]);
          most = std::max(most, expected[object].size());
        }
        for (const std::uint32_t other : colliding_tags) EXPECT_TRUE(other == tag || !frame.has(other, 0));
      }
    }
    EXPECT_GT(most, 8u);
    page.ask({{"do", "layers"}, {"colliding_nodes", nullptr}});
    EXPECT_FALSE(page.frame().has(tag, 0));
    for (const char* nodes :
         {R"(true)", R"({"level": -3})", R"({"objects": [0, 1]})", R"({"objects": [0], "level": 0})",
          R"({"objects": [0, 6], "level": 0})", R"({"level": 0, "what": 1})"})
      EXPECT_NE(page.failure(std::string(R"({"do": "layers", "colliding_nodes": )") + nodes + "}"), "");
  }
}

TEST(ViewerLayers, ListsTheNodePairsByLevel) {
  const SceneView show = crowd();
  Simulation simulation = simulation_of(show);
  TestPage page(show);
  page.scene();
  const NodePairList list = SceneInspector(simulation.scene()).node_pairs({0, 0}, {1, 0});
  const Json levels = page.ask({{"do", "node_pairs"}, {"a", 0}, {"b", 1}})["levels"];
  ASSERT_EQ(levels.size(), list.level_count());
  EXPECT_GT(levels.size(), 1u);
  EXPECT_EQ(levels[0]["leaf_pairs"], 0);
  EXPECT_EQ(levels[0]["names"], Json::array({Json::array({"A(0, 0)", "A(0, 0)"})}));
  for (std::uint32_t level = 0; level < list.level_count(); ++level) {
    const auto pairs = list.pairs_of(level);
    EXPECT_EQ(levels[level]["pairs"], pairs.size());
    const OctreeCell &a = list.nodes_a[pairs[0].a], &b = list.nodes_b[pairs[0].b];
    const auto name = [](const OctreeCell& cell) {
      return "A(" + std::to_string(*cell.number) + ", " + std::to_string(cell.number_level) + ")";
    };
    EXPECT_EQ(levels[level]["names"][0], Json::array({name(a), name(b)}));
    EXPECT_EQ(levels[level]["names"].size(), std::min<std::size_t>(pairs.size(), 100));
  }
  EXPECT_TRUE(page.ask({{"do", "node_pairs"}, {"a", 0}, {"b", 5}})["levels"].empty()) << "they are far apart";
  EXPECT_NE(page.failure(R"({"do": "node_pairs", "id": 1, "a": 0, "b": 6})").find("no object 6"),
            std::string::npos);
  Json regions = Json::array();
  for (const SceneRegion& region : SceneInspector(simulation.scene()).regions({0, 0}))
    regions.push_back("R(" + std::to_string(region.number) + ", " + std::to_string(region.level) + ")");
  EXPECT_FALSE(regions.empty());
  EXPECT_EQ(page.ask({{"do", "read"}, {"object", 0}})["regions"], regions);
  const OctreeCell leaf = SceneInspector(simulation.scene()).leaf({0, 0}, 17);
  EXPECT_EQ(page.ask({{"do", "read"}, {"object", 0}, {"triangle", 17}})["leaf"],
            "A(" + std::to_string(*leaf.number) + ", " + std::to_string(leaf.number_level) + ")");
}

/// The colliding vertices equal those of a scene that is created with this option.
TEST(ViewerLayers, CollidingVerticesAreThoseOfASceneThatGivesThem) {
  for (const ContactKinds contacts :
       {ContactKinds::intersection, ContactKinds::none, ContactKinds::continuous}) {
    SceneView show = crowd();
    show.simulation.scene.contacts = contacts;
    SceneView giving = show;
    giving.simulation.scene.contacts = ContactKinds::intersection;
    giving.simulation.scene.comparison.colliding_vertices = true;
    Simulation simulation = simulation_of(giving);
    TestPage page(show);
    page.scene();
    page.ask({{"do", "layers"}, {"colliding_vertices", true}});
    for (int step = 0; step < 10; ++step) {
      const ViewerMessage frame = step == 0 ? page.frame() : page.frame_after_steps(1);
      const DetectResult& result = step == 0 ? simulation.detect() : simulation.step();
      std::vector<std::set<std::uint32_t>> expected(show.objects.size());
      for (const CollidingVertices& group : result.colliding_vertex_groups) {
        for (std::uint32_t i = 0; i < group.count_a + group.count_b; ++i)
          expected[i < group.count_a ? group.a.index : group.b.index].insert(
              result.colliding_vertices[group.first_vertex + i]);
      }
      for (std::uint32_t i = 0; i < expected.size(); ++i) {
        const auto sent = frame.values<std::uint32_t>(42, i);
        EXPECT_EQ(sent, std::vector<std::uint32_t>(expected[i].begin(), expected[i].end()));
      }
      EXPECT_FALSE(expected[0].empty());
    }
  }
}

TEST(ViewerLayers, WhatIsTooLargeIsCutAndSaid) {
  // Twice 1200 coincident triangles: 1,440,000 pairs, all of which touch.
  SceneView show;
  for (const char* name : {"heap", "other heap"}) {
    ViewedObject heap;
    heap.mesh.name = name;
    for (std::uint32_t i = 0; i < 1200; ++i) {
      heap.mesh.positions.insert(heap.mesh.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.001 * i}});
      heap.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    show.objects.push_back(std::move(heap));
  }
  TestPage page(show);
  page.scene();
  page.ask({{"do", "layers"}, {"candidates", true}});
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.section(38).count, 1'000'000u);
  EXPECT_EQ(count_of(frame, "contacts"), 1'000'000u);
  EXPECT_EQ(frame.json["omitted"], (Json{{"contacts", 1'440'000}, {"candidates", 1'440'000}}));
  EXPECT_EQ(count_of(frame, "contact_points"),
            column_of<std::uint32_t>(frame, "contacts", "first_point").back() +
                column_of<std::uint8_t>(frame, "contacts", "point_count").back());
}

TEST(ViewerLayers, ExplainsWhatTheLibraryExplains) {
  for (const BoundingVolume volume : all_bounding_volumes) {
    const SceneView show = crowd(volume);
    Simulation simulation = simulation_of(show);
    TestPage page(show);
    const Vec3d center = center_of(page.scene());
    const char* const names[] = {"not_tested",     "shared_vertex",  "inert",      "object_volumes",
                                 "octree_volumes", "triangle_boxes", "exact_test", "contact"};
    std::set<std::string> stages, texts;
    RandomNumbers random(12345);
    for (int i = 0; i < 3000; ++i) {
      const std::uint32_t a = random.below(6), b = random.below(6), s = random.below(720),
                          t = random.below(720);
      const PairExplanation why = SceneInspector(simulation.scene()).explain({a, 0}, s, {b, 0}, t);
      const Json answer = page.ask({{"do", "explain"}, {"a", {a, s}}, {"b", {b, t}}});
      ASSERT_EQ(answer["stage"], names[static_cast<int>(why.stage)]);
      EXPECT_EQ(answer["distance"], why.distance);
      EXPECT_EQ(answer["levels"], (Json{why.level_a, why.level_b}));
      ASSERT_EQ(answer["boxes"].is_null(), why.box_a.empty());
      if (!why.box_a.empty()) {
        EXPECT_EQ(answer["boxes"][0][1][2], static_cast<double>(why.box_a.max.z) - center.z);
      }
      ASSERT_EQ(answer["spheres"].is_null(), why.sphere_a.empty());
      if (!why.sphere_a.empty()) {
        EXPECT_EQ(answer["spheres"][1][3], static_cast<double>(why.sphere_b.radius));
      }
      ASSERT_EQ(answer["edges"].is_null(), why.slabs_a.empty());
      if (!why.slabs_a.empty()) {
        const auto edges = edges_of(why.slabs_b);
        ASSERT_EQ(answer["edges"][1].size(), edges.size());
        EXPECT_EQ(answer["edges"][1][0][1][2], edges[0][1].z - center.z);
        const std::string text = answer["text"];
        EXPECT_NE(text.find(volume == BoundingVolume::obb ? "oriented box" : "-DOP"), std::string::npos)
            << text;
      }
      stages.insert(answer["stage"]);
      texts.insert(answer["text"]);
    }
    for (const char* stage : {"not_tested", "object_volumes", "octree_volumes"})
      EXPECT_TRUE(stages.contains(stage)) << stage;
    EXPECT_TRUE(texts.contains("ball 4 and ball 5 are not tested against each other: both are static"));
    EXPECT_TRUE(texts.contains("ball 1 is not tested against itself: its self-collision is off"));
    EXPECT_EQ(page.ask({{"do", "explain"}, {"a", {2, 7}}, {"b", {2, 7}}})["stage"], "shared_vertex");
  }
}

}  // namespace supple::viewer::session_layers_test
