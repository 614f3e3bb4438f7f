#include "query.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exit_status.hpp"
#include "inputs.hpp"
#include "json_writer.hpp"
#include "point_file.hpp"
#include "progress.hpp"
#include "supple/scene.hpp"
#include "supple/version.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

/// Answers the queries of a file in batches, and shows the progress.
class Run {
 public:
  explicit Run(const QueryOptions& options);

  void answer();
  void write_json() const;
  void print() const;

 private:
  template <class Query, class Result, class Answer>
  void in_batches(const std::vector<Query>& queries, std::vector<Result>& results, const Answer& answer);
  std::size_t count() const { return closest_.size() + hits_.size() + contained_.size(); }
  void write_result(JsonWriter& json, std::size_t i) const;
  void print_result(std::size_t i) const;

  const QueryOptions& options_;
  Scene scene_;
  std::vector<std::optional<ClosestPoint>> closest_;  // of the kind of the options, as the two below
  std::vector<std::optional<RayHit>> hits_;
  std::vector<Containment> contained_;
  double seconds_ = 0;
};

SceneOptions scene_options(const QueryOptions& options) {
  SceneOptions scene;
  options.given_scene.apply_to(scene);
  return scene;
}

Run::Run(const QueryOptions& options) : options_(options), scene_(scene_options(options)) {
  for (const InputObject& object : read_objects(options.inputs).objects)
    scene_.add(object.mesh, object.options);
}

template <class Query, class Result, class Answer>
void Run::in_batches(const std::vector<Query>& queries, std::vector<Result>& results, const Answer& answer) {
  constexpr std::size_t batch = 4096;
  results.resize(queries.size());
  Progress progress(queries.size(), !options_.quiet, "query");
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t first = 0; first < queries.size(); first += batch) {
    const std::size_t size = std::min(batch, queries.size() - first);
    answer(std::span(queries).subspan(first, size), std::span(results).subspan(first, size));
    progress.update(first + size, fmt::format("query {} of {}", first + size, queries.size()));
  }
  seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Run::answer() {
  switch (options_.kind) {
    case SceneQuery::closest:
      return in_batches(read_points(options_.file), closest_, [&](const auto& points, const auto& results) {
        scene_.closest(points, results,
                       {.max_distance = options_.max_distance, .signed_distance = options_.signed_distance});
      });
    case SceneQuery::inside:
      return in_batches(read_points(options_.file), contained_,
                        [&](const auto& points, const auto& results) { scene_.inside(points, results); });
    case SceneQuery::rays:
      return in_batches(read_rays(options_.file), hits_, [&](const auto& rays, const auto& results) {
        scene_.cast(rays, results, {.count_hits = options_.all_hits});
      });
  }
}

void Run::write_result(JsonWriter& json, std::size_t i) const {
  const auto begin = [&](ObjectId object, std::uint32_t triangle, double number) {
    json.begin_array();
    json.value(object.index);
    json.value(triangle);
    json.value(number);
  };
  if (options_.kind == SceneQuery::inside) {
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
  json.end_object();
  json.close();
}

void Run::print_result(std::size_t i) const {
  const auto print_triangle = [&](ObjectId object, std::uint32_t triangle, double number) {
    fmt::print("{:>8}  {}  triangle {}  {:.9g}", i, name_of(scene_, object), triangle, number);
  };
  if (options_.kind == SceneQuery::inside) {
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
                                      "     ray  object  first triangle  t\n"};
  if (count() == 0) {
    fmt::print("There are no queries.\n");
    return;
  }
  fmt::print("{}", headings[static_cast<std::size_t>(options_.kind)]);
  for (std::size_t i = 0; i < std::min(count(), most_rows); ++i) print_result(i);
  if (count() > most_rows)
    fmt::print("{:>8}  {} more; --json writes all of them\n", "", grouped(count() - most_rows));
  fmt::print("{} in {:.3g} s, {:.3g} µs each\n", counted(count(), "query", "queries"), seconds_,
             1e6 * seconds_ / static_cast<double>(count()));
}

}  // namespace

int run_query(const QueryOptions& options) {
  Run run(options);
  run.answer();
  if (!options.json.empty()) run.write_json();
  if (!options.quiet && options.json != "-") run.print();
  return exit_done;
}

}  // namespace supple::cli
