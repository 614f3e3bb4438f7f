#include "commands/commands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <limits>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/exit_status.hpp"
#include "base/files.hpp"
#include "base/interruption.hpp"
#include "base/json_writer.hpp"
#include "base/progress.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "query/query_file.hpp"
#include "reports/result_json.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"

namespace supple::cli {
namespace {

/// Answers the queries of a file in batches, or finds the distances of all objects, and shows the progress.
class Run {
 public:
  explicit Run(const QueryOptions& options);

  /// Returns the exit status.
  int go();

 private:
  void answer(Interruption& interruption);
  int report(bool was_ended) const;
  void write_json(bool is_truncated) const;
  void print() const;
  /// With `--verify`, writes one line to standard error when an answer is wrong; returns the exit status.
  int report_wrong_answers() const;
  template <class Query, class Result, class Answer, class Verify>
  void in_batches(Interruption& interruption, std::vector<Query> queries, std::vector<Result>& results,
                  const Answer& answer, const Verify& verify);
  void find_distances(Interruption& interruption);
  void write_result(JsonWriter& json, std::size_t i) const;
  void print_result(std::size_t i) const;
  void warn_of_objects_without_triangles() const;

  const QueryOptions& options_;
  Scene scene_;
  std::vector<bool> is_seen_;  // by object: it has a triangle of finite coordinates; for distances, or a line
  std::vector<std::optional<ClosestPoint>> closest_;  // of the kind of the options, as the three below
  std::vector<std::optional<RayHit>> hits_;
  std::vector<Containment> contained_;
  std::vector<ProximityPair> distances_;
  std::vector<WrongAnswer> wrong_;
  double seconds_ = 0;
  std::size_t count_ = 0, checked_ = 0;  // results, and those that were checked by brute force
  // Points, rays or pairs of objects; more than `count_` when a limit or a signal ended the run.
  std::size_t total_ = std::numeric_limits<std::size_t>::max();
};

SceneOptions scene_options(const QueryOptions& options) {
  SceneOptions scene;
  options.given_scene.apply_to(scene);
  return scene;
}

Run::Run(const QueryOptions& options) : options_(options), scene_(scene_options(options)) {
  Input input = read_objects(options.inputs, {}, {options.conversion, {}, {}});
  for (InputObject& object : input.objects) {
    options.given_objects.apply_to(object.options);
    object.splits = object.splits || options.parts;
  }
  split_parts(input);
  print_notes(input);
  if (!options.file.empty()) input.files.emplace_back(options.file);
  check_output_names({{"--json", options.json}}, input.files);
  warn_of_missing_threads(scene_.options().threads);
  for (const InputObject& object : input.objects) {
    scene_.add(object.mesh, object.options);
    const bool has_lines = !object.mesh.edges.empty() || !object.mesh.points.empty();
    is_seen_.push_back(count_finite_triangles(object.mesh) > 0 ||
                       (options_.kind == SceneQuery::distance && has_lines));
  }
}

/// Calls `work(first, size)` for batches of `count` queries, and shows the progress. `done` counts the
/// queries of finished batches.
template <class Work>
void for_batches(Interruption& interruption, std::size_t count, std::size_t batch, bool shows_progress,
                 const char* noun, std::size_t& done, const Work& work) {
  Progress progress(count, shows_progress, noun);
  for (std::size_t first = 0; first < count && !interruption.is_requested(); first += batch) {
    const std::size_t size = std::min(batch, count - first);
    work(first, size);
    if (interruption.token().stop_requested()) break;  // its answers may be missing
    const auto hold = interruption.hold();
    done = first + size;
    progress.update(done, fmt::format("{} {} of {}", noun, done, count));
  }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::max(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0.0);
}

template <class Query, class Result, class Answer, class Verify>
void Run::in_batches(Interruption& interruption, std::vector<Query> queries, std::vector<Result>& results,
                     const Answer& answer, const Verify& verify) {
  constexpr std::size_t batch = 1 << 16, verified_batch = 128;
  total_ = queries.size();
  queries.resize(std::min<std::uint64_t>(total_, options_.limits.max_contacts));
  results.resize(queries.size());
  const auto start = std::chrono::steady_clock::now();
  for_batches(interruption, queries.size(), batch, !options_.quiet, "query", count_,
              [&](std::size_t first, std::size_t size) {
                answer(std::span(queries).subspan(first, size), std::span(results).subspan(first, size));
              });
  seconds_ = seconds_since(start);
  if (!options_.verify) return;
  for_batches(interruption, count_, verified_batch, !options_.quiet, "answer", checked_,
              [&](std::size_t first, std::size_t size) {
                std::vector<WrongAnswer> found =
                    verify(std::span(queries).subspan(first, size),
                           std::span(std::as_const(results)).subspan(first, size));
                const auto hold = interruption.hold();
                for (WrongAnswer& wrong : found) {
                  wrong.query += first;
                  wrong_.push_back(std::move(wrong));
                }
              });
}

void Run::find_distances(Interruption& interruption) {
  if (scene_.objects().size() < 2)
    fail("{}: has {}; distances need two, so add meshes, or objects to the scene", options_.inputs.front(),
         counted(scene_.objects().size(), "object"));
  const auto start = std::chrono::steady_clock::now();
  const CallLimits limits{interruption.token()};
  const auto found = scene_.distances(options_.max_distance, limits);
  if (limits.stop.stop_requested()) return;
  {
    const auto hold = interruption.hold();
    seconds_ = seconds_since(start);
    distances_.assign(found.begin(), found.end());
    total_ = found.size();
    count_ = std::min<std::uint64_t>(total_, options_.limits.max_contacts);
  }
  if (!options_.verify || interruption.is_requested()) return;
  std::vector<WrongAnswer> wrong = verify_distances(scene_, options_.max_distance, distances_);
  const auto hold = interruption.hold();
  wrong_ = std::move(wrong);
  checked_ = total_;
}

void Run::answer(Interruption& interruption) {
  const ClosestOptions closest{.max_distance = options_.max_distance,
                               .signed_distance = options_.signed_distance,
                               .limits = {interruption.token()}};
  const CastOptions cast{.count_hits = options_.all_hits, .limits = {interruption.token()}};
  switch (options_.kind) {
    case SceneQuery::closest:
      return in_batches(
          interruption, read_points(options_.file), closest_,
          [&](const auto& points, const auto& results) { scene_.closest(points, results, closest); },
          [&](const auto& points, const auto& results) {
            return verify_closest(scene_, points, results, closest);
          });
    case SceneQuery::inside:
      return in_batches(
          interruption, read_points(options_.file), contained_,
          [&](const auto& points, const auto& results) {
            scene_.inside(points, results, {}, {interruption.token()});
          },
          [&](const auto& points, const auto& results) { return verify_inside(scene_, points, results); });
    case SceneQuery::rays:
      return in_batches(
          interruption, read_rays(options_.file), hits_,
          [&](const auto& rays, const auto& results) { scene_.cast(rays, results, cast); },
          [&](const auto& rays, const auto& results) { return verify_cast(scene_, rays, results, cast); });
    case SceneQuery::distance:
      return find_distances(interruption);
  }
}

int Run::go() {
  warn_of_objects_without_triangles();
  const auto end_early = [this](const Interruption& end) {
    const bool is_checking = count_ > 0 && (count_ == total_ || count_ >= options_.limits.max_contacts);
    const std::string place =
        is_checking ? fmt::format("the check of {}", counted(checked_, "answer")) : counted(count_, "result");
    return report_end(end, options_.limits.seconds, place, report(true));
  };
  Interruption interruption(options_.limits.seconds,
                            [&](const Interruption& end) { exit_now(end_early(end)); });
  answer(interruption);
  interruption.end();
  const bool is_whole = (count_ == total_ || count_ >= options_.limits.max_contacts) &&
                        (!options_.verify || checked_ >= count_);
  return is_whole ? report(false) : end_early(interruption);
}

/// Returns the exit status.
int Run::report(bool was_ended) const {
  if (!options_.json.empty()) write_json(count_ < total_);
  if (!options_.quiet && options_.json != "-") print();
  if (count_ < total_ && !was_ended)
    fmt::print(stderr, "supple: there are more results than --max-contacts {}; they are truncated\n",
               options_.limits.max_contacts);
  return report_wrong_answers();
}

/// Answers without a triangle mean nothing.
void Run::warn_of_objects_without_triangles() const {
  std::vector<std::string> names;
  for (const ObjectId object : scene_.objects()) {
    if (!is_seen_[object.index]) names.push_back(name_of(scene_, object));
  }
  if (names.empty()) return;
  if (names.size() == scene_.objects().size())
    fail(
        "{}: no object has a triangle of finite coordinates, so there is nothing to query; give "
        "surfaces of triangles, not lines or clouds of points",
        options_.inputs.front());
  if (!options_.quiet)
    fmt::print(
        stderr,
        "supple: warning: {} without triangles of finite coordinates, which no query finds; the first: {}\n",
        counted(names.size(), "object"), names.front());
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

void Run::write_json(bool is_truncated) const {
  JsonWriter json(options_.json);
  json.member("query", word_of(options_.kind));
  json.objects("objects", scene_.objects(), [&](ObjectId object) {
    json.member("name", scene_.options(object).name);
    json.member("vertices", std::uint64_t{scene_.vertex_count(object)});
    json.member("triangles", std::uint64_t{scene_.triangle_count(object)});
  });
  json.list("results", std::views::iota(std::size_t{0}, count_),
            [&](std::size_t i) { write_result(json, i); });
  json.member("truncated", is_truncated);
  if (options_.verify) {
    json.object("verify", [&] {
      json.member("answers_checked", std::uint64_t{checked_});
      json.objects("differences", wrong_, [&](const WrongAnswer& wrong) {
        json.member("query", wrong.query);
        json.member("found", wrong.found);
        json.member("expected", wrong.expected);
      });
    });
  }
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
  if (count_ == 0 && count_ < total_) return;
  if (count_ == 0 && !are_distances) return fmt::print("There are no queries.\n");
  if (count_ == 0)
    return fmt::print(
        "{}", std::ranges::count(is_seen_, true) < 2
                  ? "There are no two objects with triangles, lines or points, so there is no distance.\n"
                  : "No two objects are within the distance.\n");
  fmt::print("{}", headings[static_cast<std::size_t>(options_.kind)]);
  for (std::size_t i = 0; i < std::min(count_, most_rows); ++i) print_result(i);
  if (count_ > most_rows)
    fmt::print("{:>8}  {} more; --json writes all of them\n", "", grouped(count_ - most_rows));
  fmt::print("{} in {:.3g} s, {:.3g} µs each\n",
             are_distances ? counted(count_, "pair") : counted(count_, "query", "queries"), seconds_,
             1e6 * seconds_ / static_cast<double>(count_));
  if (options_.verify)
    fmt::print("verified: {} checked by brute force, {}\n", counted(checked_, "answer"),
               wrong_.empty() ? "no difference" : counted(wrong_.size(), "difference"));
}

}  // namespace

int run_query(const QueryOptions& options) {
  return Run(options).go();
}

}  // namespace supple::cli
