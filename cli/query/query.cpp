#include "commands/commands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/files.hpp"
#include "base/interruption.hpp"
#include "base/json_writer.hpp"
#include "base/progress.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "commands/build_simulation.hpp"
#include "inputs/inputs.hpp"
#include "query/query_file.hpp"
#include "reports/result_json.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"

namespace supple::cli {
namespace {

SceneOptions scene_options(const QueryOptions& options) {
  SceneOptions scene;
  options.given_scene.apply_to(scene);
  return scene;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::max(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0.0);
}

/// A triangle that answers a query, with its distance or its place on the ray.
struct FoundTriangle {
  ObjectId object;
  std::uint32_t triangle;
  double number;
  std::optional<std::uint64_t> hits{};
};

/// Answers the queries of a file in batches, or finds the distances of all objects, and shows the progress.
class Run {
 public:
  explicit Run(const QueryOptions& options) : options_(options), scene_(scene_options(options)) {
    Input input = read_objects(options.inputs, {}, {options.conversion, {}, {}});
    apply_to_objects(options.given_objects, false, options.parts, input);
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

  /// Returns the exit status.
  int go() {
    warn_of_objects_without_triangles();
    const auto end_early = [this](const Interruption& end) {
      const bool is_checking = count_ > 0 && (count_ == total_ || count_ >= options_.limits.max_contacts);
      const std::string place = is_checking ? fmt::format("the check of {}", counted(checked_, "answer"))
                                            : counted(count_, "result");
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

 private:
  void answer(Interruption& interruption) {
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

  /// Returns the exit status.
  int report(bool was_ended) const {
    if (!options_.json.empty()) write_json(count_ < total_);
    if (!options_.quiet && options_.json != "-") print();
    if (count_ < total_ && !was_ended)
      fmt::print(stderr, "supple: there are more results than --max-contacts {}; they are truncated\n",
                 options_.limits.max_contacts);
    return report_wrong_answers();
  }

  void write_json(bool is_truncated) const {
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

  void print() const {
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

  /// With `--verify`, writes one line to standard error when an answer is wrong; returns the exit status.
  int report_wrong_answers() const {
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

  /// Calls `work(first, size)` for batches of `count` queries, and shows the progress. `done` counts the
  /// queries of finished batches.
  void for_batches(Interruption& interruption, std::size_t count, std::size_t batch, const char* noun,
                   std::size_t& done, const auto& work) const {
    Progress progress(count, !options_.quiet, noun);
    for (std::size_t first = 0; first < count && !interruption.is_requested(); first += batch) {
      const std::size_t size = std::min(batch, count - first);
      work(first, size);
      if (interruption.token().stop_requested()) break;  // its answers may be missing
      const auto hold = interruption.hold();
      done = first + size;
      progress.update(done, fmt::format("{} {} of {}", noun, done, count));
    }
  }

  template <class Query, class Result>
  void in_batches(Interruption& interruption, std::vector<Query> queries, std::vector<Result>& results,
                  const auto& answer, const auto& verify) {
    constexpr std::size_t batch = 1 << 16, verified_batch = 128;
    total_ = queries.size();
    queries.resize(std::min<std::uint64_t>(total_, options_.limits.max_contacts));
    results.resize(queries.size());
    const auto start = std::chrono::steady_clock::now();
    for_batches(interruption, queries.size(), batch, "query", count_,
                [&](std::size_t first, std::size_t size) {
                  answer(std::span(queries).subspan(first, size), std::span(results).subspan(first, size));
                });
    seconds_ = seconds_since(start);
    if (!options_.verify) return;
    for_batches(
        interruption, count_, verified_batch, "answer", checked_, [&](std::size_t first, std::size_t size) {
          std::vector<WrongAnswer> found = verify(std::span(queries).subspan(first, size),
                                                  std::span(std::as_const(results)).subspan(first, size));
          const auto hold = interruption.hold();
          for (WrongAnswer& wrong : found) {
            wrong.query += first;
            wrong_.push_back(std::move(wrong));
          }
        });
  }

  void find_distances(Interruption& interruption) {
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

  /// The answer to a query for a triangle, if there is one.
  std::optional<FoundTriangle> found_triangle(std::size_t i) const {
    if (options_.kind == SceneQuery::closest && closest_[i])
      return FoundTriangle{closest_[i]->object, closest_[i]->triangle, closest_[i]->distance};
    if (options_.kind != SceneQuery::rays || !hits_[i]) return std::nullopt;
    const RayHit& hit = *hits_[i];
    return FoundTriangle{hit.object, hit.triangle, hit.t,
                         options_.all_hits ? std::optional(hit.hits) : std::nullopt};
  }

  void write_result(JsonWriter& json, std::size_t i) const {
    if (options_.kind == SceneQuery::distance) return write_distance(json, distances_[i]);
    if (options_.kind == SceneQuery::inside) return json.value(word_of(contained_[i]));
    const auto found = found_triangle(i);
    if (!found) return json.null();
    if (found->hits) return json.row(found->object.index, found->triangle, found->number, *found->hits);
    json.row(found->object.index, found->triangle, found->number);
  }

  void print_result(std::size_t i) const {
    if (options_.kind == SceneQuery::distance) {
      const ProximityPair& pair = distances_[i];
      const auto point = [](const Vec3d& p) {
        return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x, p.y, p.z);
      };
      fmt::print("  {}  {}  {:.9g}  {} to {}  {} to {}\n", name_of(scene_, pair.object_a),
                 name_of(scene_, pair.object_b), pair.distance, element_name(pair.kind_a, pair.element_a),
                 element_name(pair.kind_b, pair.element_b), point(pair.point_a), point(pair.point_b));
    } else if (options_.kind == SceneQuery::inside) {
      fmt::print("{:>8}  {}\n", i, word_of(contained_[i]));
    } else if (const auto found = found_triangle(i)) {
      fmt::print("{:>8}  {}  triangle {}  {:.9g}{}\n", i, name_of(scene_, found->object), found->triangle,
                 found->number, found->hits ? "  " + counted(*found->hits, "triangle") : "");
    } else {
      fmt::print("{:>8}  none\n", i);
    }
  }

  /// Answers without a triangle mean nothing.
  void warn_of_objects_without_triangles() const {
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
      fmt::print(stderr,
                 "supple: warning: {} without triangles of finite coordinates, which no query finds; the "
                 "first: {}\n",
                 counted(names.size(), "object"), names.front());
  }

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

}  // namespace

int run_query(const QueryOptions& options) {
  return Run(options).go();
}

}  // namespace supple::cli
