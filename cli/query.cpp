#include "query.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exit_status.hpp"
#include "inputs.hpp"
#include "json_writer.hpp"
#include "missing_threads.hpp"
#include "output_names.hpp"
#include "point_file.hpp"
#include "progress.hpp"
#include "proximity_json.hpp"
#include "supple/error.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/scene.hpp"
#include "supple/version.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

/// Answers the queries of a file in batches, or finds the distances of all objects, and shows the progress.
class Run {
 public:
  explicit Run(const QueryOptions& options);

  void answer();
  void write_json() const;
  void print() const;
  /// With `--verify`, writes one line to standard error when an answer is wrong; returns the exit status.
  int report_wrong_answers() const;

 private:
  template <class Query, class Result, class Answer, class Verify>
  void in_batches(const std::vector<Query>& queries, std::vector<Result>& results, const Answer& answer,
                  const Verify& verify);
  void find_distances();
  std::size_t count() const { return closest_.size() + hits_.size() + contained_.size() + distances_.size(); }
  void write_result(JsonWriter& json, std::size_t i) const;
  void print_result(std::size_t i) const;

  const QueryOptions& options_;
  Scene scene_;
  std::vector<std::optional<ClosestPoint>> closest_;  // of the kind of the options, as the three below
  std::vector<std::optional<RayHit>> hits_;
  std::vector<Containment> contained_;
  std::vector<ProximityPair> distances_;
  std::vector<WrongAnswer> wrong_;
  double seconds_ = 0;
};

SceneOptions scene_options(const QueryOptions& options) {
  SceneOptions scene;
  options.given_scene.apply_to(scene);
  return scene;
}

Run::Run(const QueryOptions& options) : options_(options), scene_(scene_options(options)) {
  Input input = read_objects(options.inputs, {}, {options.conversion, {}, {}});
  print_notes(input);
  if (!options.file.empty()) input.files.emplace_back(options.file);
  check_output_names({{"--json", options.json}}, input.files);
  warn_of_missing_threads(scene_.options().threads);
  for (const InputObject& object : input.objects) scene_.add(object.mesh, object.options);
}

/// Calls `work(first, size)` for batches of `count` queries, and shows the progress.
template <class Work>
void for_batches(std::size_t count, std::size_t batch, bool shows_progress, const char* noun,
                 const Work& work) {
  Progress progress(count, shows_progress, noun);
  for (std::size_t first = 0; first < count; first += batch) {
    const std::size_t size = std::min(batch, count - first);
    work(first, size);
    progress.update(first + size, fmt::format("{} {} of {}", noun, first + size, count));
  }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::max(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0.0);
}

template <class Query, class Result, class Answer, class Verify>
void Run::in_batches(const std::vector<Query>& queries, std::vector<Result>& results, const Answer& answer,
                     const Verify& verify) {
  constexpr std::size_t batch = 1 << 16, verified_batch = 128;
  results.resize(queries.size());
  const auto start = std::chrono::steady_clock::now();
  for_batches(queries.size(), batch, !options_.quiet, "query", [&](std::size_t first, std::size_t size) {
    answer(std::span(queries).subspan(first, size), std::span(results).subspan(first, size));
  });
  seconds_ = seconds_since(start);
  if (!options_.verify) return;
  for_batches(queries.size(), verified_batch, !options_.quiet, "answer",
              [&](std::size_t first, std::size_t size) {
                for (WrongAnswer& wrong : verify(std::span(queries).subspan(first, size),
                                                 std::span(std::as_const(results)).subspan(first, size))) {
                  wrong.query += first;
                  wrong_.push_back(std::move(wrong));
                }
              });
}

void Run::find_distances() {
  if (scene_.objects().size() < 2)
    throw Error(fmt::format("{}: has {}; distances need two, so add meshes, or objects to the scene",
                            options_.inputs.front(), counted(scene_.objects().size(), "object")));
  const auto start = std::chrono::steady_clock::now();
  const auto found = scene_.distances(options_.max_distance);
  seconds_ = seconds_since(start);
  distances_.assign(found.begin(), found.end());
  if (options_.verify) wrong_ = scene_.verify_distances(options_.max_distance, distances_);
}

void Run::answer() {
  const ClosestOptions closest{.max_distance = options_.max_distance,
                               .signed_distance = options_.signed_distance};
  const CastOptions cast{.count_hits = options_.all_hits};
  switch (options_.kind) {
    case SceneQuery::closest:
      return in_batches(
          read_points(options_.file), closest_,
          [&](const auto& points, const auto& results) { scene_.closest(points, results, closest); },
          [&](const auto& points, const auto& results) {
            return scene_.verify_closest(points, results, closest);
          });
    case SceneQuery::inside:
      return in_batches(
          read_points(options_.file), contained_,
          [&](const auto& points, const auto& results) { scene_.inside(points, results); },
          [&](const auto& points, const auto& results) { return scene_.verify_inside(points, results); });
    case SceneQuery::rays:
      return in_batches(
          read_rays(options_.file), hits_,
          [&](const auto& rays, const auto& results) { scene_.cast(rays, results, cast); },
          [&](const auto& rays, const auto& results) { return scene_.verify_cast(rays, results, cast); });
    case SceneQuery::distance:
      return find_distances();
  }
}

int Run::report_wrong_answers() const {
  if (wrong_.empty()) return exit_done;
  const WrongAnswer& first = wrong_.front();
  // The words of distances name the objects.
  const std::string query =
      options_.kind == SceneQuery::distance
          ? ""
          : fmt::format("{} {}: ", options_.kind == SceneQuery::rays ? "ray" : "point", first.query);
  fmt::print(stderr, "supple: verify: {} from brute force; the first: {}{}, but brute force finds {}\n",
             counted(wrong_.size(), "difference"), query, one_line(first.found), one_line(first.expected));
  return exit_differences;
}

void Run::write_result(JsonWriter& json, std::size_t i) const {
  const auto begin = [&](ObjectId object, std::uint32_t triangle, double number) {
    json.begin_array();
    json.value(object.index);
    json.value(triangle);
    json.value(number);
  };
  if (options_.kind == SceneQuery::distance) {
    write_distance(json, distances_[i]);
  } else if (options_.kind == SceneQuery::inside) {
    json.value(word_of(contained_[i]));
  } else if (options_.kind == SceneQuery::closest && closest_[i]) {
    begin(closest_[i]->object, closest_[i]->triangle, closest_[i]->distance);
    json.end_array();
  } else if (options_.kind == SceneQuery::rays && hits_[i]) {
    begin(hits_[i]->object, hits_[i]->triangle, hits_[i]->t);
    if (options_.all_hits) json.value(hits_[i]->hits);
    json.end_array();
  } else {
    json.null();
  }
}

void Run::write_json() const {
  JsonWriter json(options_.json);
  json.begin_object();
  json.member("supple", std::string(SUPPLE_VERSION));
  json.member("query", word_of(options_.kind));
  json.key("objects");
  json.begin_array();
  for (const ObjectId object : scene_.objects()) {
    json.begin_object();
    json.member("name", scene_.name(object));
    json.member("vertices", std::uint64_t{scene_.vertex_count(object)});
    json.member("triangles", std::uint64_t{scene_.triangle_count(object)});
    json.end_object();
  }
  json.end_array();
  json.key("results");
  json.begin_array();
  for (std::size_t i = 0; i < count(); ++i) write_result(json, i);
  json.end_array();
  if (options_.verify) {
    json.key("verify");
    json.begin_object();
    json.member("answers_checked", std::uint64_t{count()});
    json.key("differences");
    json.begin_array();
    for (const WrongAnswer& wrong : wrong_) {
      json.begin_object();
      json.member("query", wrong.query);
      json.member("found", wrong.found);
      json.member("expected", wrong.expected);
      json.end_object();
    }
    json.end_array();
    json.end_object();
  }
  json.end_object();
  json.close();
}

void Run::print_result(std::size_t i) const {
  const auto print_triangle = [&](ObjectId object, std::uint32_t triangle, double number) {
    fmt::print("{:>8}  {}  triangle {}  {:.9g}", i, name_of(scene_, object), triangle, number);
  };
  if (options_.kind == SceneQuery::distance) {
    const ProximityPair& pair = distances_[i];
    const auto element = [](FeatureKind kind, const std::array<std::uint32_t, 2>& ids) {
      return kind == FeatureKind::edge ? fmt::format("edge {} {}", ids[0], ids[1])
                                       : fmt::format("{} {}", word_of(kind), ids[0]);
    };
    const auto point = [](const Vec3d& p) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x, p.y, p.z); };
    fmt::print("  {}  {}  {:.9g}  {} to {}  {} to {}", name_of(scene_, pair.object_a),
               name_of(scene_, pair.object_b), pair.distance, element(pair.kind_a, pair.element_a),
               element(pair.kind_b, pair.element_b), point(pair.point_a), point(pair.point_b));
  } else if (options_.kind == SceneQuery::inside) {
    fmt::print("{:>8}  {}", i, word_of(contained_[i]));
  } else if (options_.kind == SceneQuery::closest && closest_[i]) {
    print_triangle(closest_[i]->object, closest_[i]->triangle, closest_[i]->distance);
  } else if (options_.kind == SceneQuery::rays && hits_[i]) {
    print_triangle(hits_[i]->object, hits_[i]->triangle, hits_[i]->t);
    if (options_.all_hits) fmt::print("  {}", counted(hits_[i]->hits, "triangle"));
  } else {
    fmt::print("{:>8}  none", i);
  }
  fmt::print("\n");
}

void Run::print() const {
  constexpr const char* headings[] = {"   point  object  nearest triangle  distance\n", "   point  place\n",
                                      "     ray  object  first triangle  t\n",
                                      "  a  b  distance  nearest elements  nearest points\n"};
  const bool are_distances = options_.kind == SceneQuery::distance;
  if (count() == 0)
    return fmt::print(
        "{}", are_distances ? "No two objects are within the distance.\n" : "There are no queries.\n");
  fmt::print("{}", headings[static_cast<std::size_t>(options_.kind)]);
  for (std::size_t i = 0; i < std::min(count(), most_rows); ++i) print_result(i);
  if (count() > most_rows)
    fmt::print("{:>8}  {} more; --json writes all of them\n", "", grouped(count() - most_rows));
  fmt::print("{} in {:.3g} s, {:.3g} µs each\n",
             are_distances ? counted(count(), "pair") : counted(count(), "query", "queries"), seconds_,
             1e6 * seconds_ / static_cast<double>(count()));
  if (options_.verify)
    fmt::print("verified: {} checked by brute force, {}\n", counted(count(), "answer"),
               wrong_.empty() ? "no difference" : counted(wrong_.size(), "difference"));
}

}  // namespace

int run_query(const QueryOptions& options) {
  Run run(options);
  run.answer();
  if (!options.json.empty()) run.write_json();
  if (!options.quiet && options.json != "-") run.print();
  return run.report_wrong_answers();
}

}  // namespace supple::cli
