#include "commands/commands.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "base/files.hpp"
#include "base/json_writer.hpp"
#include "base/progress.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "supple/difference_descriptions.hpp"
#include "supple/result.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/verify.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

/// A query on which `first_impact` and `first_contact_by_algebra` differ.
struct QueryDifference {
  std::uint64_t query = 0;
  ContinuousDifference::Fault fault = ContinuousDifference::Fault::missed;
  std::optional<double> reported;    ///< none: reported as apart
  std::optional<TimeBracket> truth;  ///< none: the elements stay apart
};

/// The results of the queries of one file.
struct QueryFileResult {
  std::string path;
  QueryKind kind = QueryKind::vertex_face;
  std::vector<std::optional<double>> times;  ///< time of the first impact of each query
  std::uint64_t touching = 0;
  std::uint64_t within_tolerance = 0;  ///< number of queries that are only within tolerance
  bool compared = false;               ///< whether answers are known
  std::vector<std::uint64_t> false_negatives, false_positives;
  double seconds_per_query = 0;
  std::vector<QueryDifference> differences;  ///< only with --verify
};

struct QueryPaths {
  fs::path queries;
  fs::path answers;  ///< empty: the answers are in the query file
  std::uint64_t bytes = 0;
};

std::vector<QueryPaths> paths_of(const CcdQueriesOptions& options) {
  const std::vector<fs::path> queries = expand_patterns(options.inputs);
  const std::vector<fs::path> answers = expand_patterns(options.answers);
  for (const auto& inputs : {queries, answers}) check_output_names({{"--json", options.json}}, inputs);
  if (!answers.empty() && answers.size() != queries.size())
    fail("--answers: {} for {}; give one for each, in the same order", counted(answers.size(), "file"),
         counted(queries.size(), "query file", "query files"));
  std::vector<QueryPaths> paths;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (!fs::exists(queries[i]))
      fail("{}: there is no such file; check the folder and the spelling", queries[i].string());
    std::error_code is_no_file;
    const std::uintmax_t bytes = fs::file_size(queries[i], is_no_file);
    paths.push_back({queries[i], answers.empty() ? fs::path{} : answers[i], is_no_file ? 0 : bytes});
  }
  return paths;
}

template <class Motion>
double measure_seconds_per_query(const std::vector<Motion>& queries, const ImpactOptions& options) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::duration<double> long_enough(0.05);
  constexpr std::uint64_t most_calls = 10'000'000;  // for clocks that stand still
  if (queries.empty()) return 0;
  const Clock::time_point start = Clock::now();
  std::chrono::duration<double> taken{};
  std::uint64_t passes = 0;
  do {
    for (const Motion& query : queries) (void)first_impact(query, options);
    ++passes;
    taken = Clock::now() - start;
  } while (taken < long_enough && passes * queries.size() < most_calls);
  return std::max(taken.count(), 0.0) / (static_cast<double>(passes) * static_cast<double>(queries.size()));
}

/// Compares a reported impact with the true one; nothing when it is within the contract.
std::optional<ContinuousDifference::Fault> fault_of(const std::optional<Impact>& impact,
                                                    const std::optional<TimeBracket>& truth) {
  using Fault = ContinuousDifference::Fault;
  if (!impact) return truth ? std::optional(Fault::missed) : std::nullopt;
  if (!truth)
    return impact->certainty == ImpactCertainty::certain ? std::optional(Fault::added) : std::nullopt;
  const bool touching_at_start = truth->high == 0;
  if (impact->toi > truth->low || (touching_at_start && !impact->touching_at_start)) return Fault::late;
  if (!touching_at_start && impact->touching_at_start) return Fault::early;
  const bool is_certain = impact->certainty == ImpactCertainty::certain;
  if (is_certain && impact->toi < truth->high - toi_tolerance_at(truth->high)) return Fault::early;
  return std::nullopt;
}

/// Calls `show(number)` after each query.
template <class Motion, class Show>
void answer(const std::vector<Motion>& queries, const CcdQueriesOptions& options, QueryFileResult& result,
            const Show& show) {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const std::optional<Impact> impact = first_impact(queries[i], options.impact);
    result.times.push_back(impact ? std::optional(impact->toi) : std::nullopt);
    result.touching += impact ? 1 : 0;
    result.within_tolerance += impact && impact->certainty == ImpactCertainty::within_tolerance ? 1 : 0;
    if (options.verify) {
      const auto truth = first_contact_by_algebra(queries[i], options.impact.min_separation);
      if (const auto fault = fault_of(impact, truth))
        result.differences.push_back({i, *fault, result.times[i], truth});
    }
    show(i);
  }
  result.seconds_per_query = measure_seconds_per_query(queries, options.impact);
}

QueryFileResult answer_file(const QueryPaths& paths, const CcdQueriesOptions& options, Progress& progress,
                            std::uint64_t bytes_before) {
  QueryFileResult result;
  result.path = paths.queries.string();
  result.kind = options.kind ? *options.kind : kind_of(paths.queries);
  QueryFile file = read_query_file(paths.queries, result.kind);
  if (!paths.answers.empty()) read_answers(paths.answers, file);
  const auto show = [&](std::uint64_t query) {
    progress.update(bytes_before + paths.bytes * query / file.size(),
                    fmt::format("query {} of {} in {}", query, file.size(), result.path));
  };
  std::visit([&](const auto& queries) { answer(queries, options, result, show); }, file.queries);
  result.compared = file.answers.has_value();
  for (std::size_t i = 0; result.compared && i < file.size(); ++i) {
    if (result.times[i].has_value() == (*file.answers)[i]) continue;
    (result.times[i] ? result.false_positives : result.false_negatives).push_back(i);
  }
  return result;
}

/// Sums over all files.
struct Totals {
  std::uint64_t queries = 0, touching = 0, within_tolerance = 0, compared = 0;
  std::uint64_t false_negatives = 0, false_positives = 0, differences = 0;
  double seconds = 0;

  explicit Totals(std::span<const QueryFileResult> files) {
    for (const QueryFileResult& file : files) {
      queries += file.times.size();
      touching += file.touching;
      within_tolerance += file.within_tolerance;
      compared += file.compared ? file.times.size() : 0;
      false_negatives += file.false_negatives.size();
      false_positives += file.false_positives.size();
      differences += file.differences.size();
      seconds += file.seconds_per_query * static_cast<double>(file.times.size());
    }
  }

  std::uint64_t false_answers() const { return false_negatives + false_positives; }
  double seconds_per_query() const {
    return seconds / static_cast<double>(std::max<std::uint64_t>(queries, 1));
  }
};

void print_row(std::size_t width, const std::string& name, const Totals& of, bool compared) {
  const auto count = [&](std::uint64_t number) { return compared ? grouped(number) : std::string("-"); };
  fmt::print("{:<{}} {:>11} {:>11} {:>15} {:>15} {:>10.0f}\n", name, width, grouped(of.queries),
             grouped(of.touching), count(of.false_negatives), count(of.false_positives),
             1e9 * of.seconds_per_query());
}

void print_false(const QueryFileResult& file) {
  std::vector<std::uint64_t> queries = file.false_negatives;
  queries.insert(queries.end(), file.false_positives.begin(), file.false_positives.end());
  std::sort(queries.begin(), queries.end());
  for (const std::uint64_t query : queries) {
    const std::optional<double> time = file.times[query];
    fmt::print("{}: query {}: {}\n", one_line(file.path), query,
               time ? fmt::format("false positive, said to touch at {}", *time) : "false negative");
  }
}

void print_differences(const QueryFileResult& file) {
  for (const QueryDifference& d : file.differences) {
    fmt::print("{}: query {}: {}: {}, by algebra {}\n", one_line(file.path), d.query, word_of(d.fault),
               d.reported ? fmt::format("reported at {}", *d.reported) : "not reported",
               d.truth ? fmt::format("from {} to {}", d.truth->low, d.truth->high) : "no contact");
  }
}

void print_comparison(const Totals& all) {
  if (all.queries == 0) {
    fmt::print("There are no queries.\n");
  } else if (all.compared == 0) {
    fmt::print("There are no answers to compare with.\n");
  } else {
    fmt::print(
        "{} compared with answers, {}\n", counted(all.compared, "query", "queries"),
        all.false_answers() == 0 ? "none is false" : counted(all.false_answers(), "is false", "are false"));
    if (all.compared < all.queries)
      fmt::print("{} without an answer to compare with\n",
                 counted(all.queries - all.compared, "query", "queries"));
  }
}

void write_differences(JsonWriter& json, const std::vector<QueryDifference>& differences) {
  json.objects("differences", differences, [&](const QueryDifference& d) {
    json.member("query", d.query);
    json.member("fault", word_of(d.fault));
    json.member("reported", d.reported);
    json.list("algebra", d.truth ? std::vector{d.truth->low, d.truth->high} : std::vector<double>());
  });
}

/// Prints a table with one row per file and a total. With `list_false`, it also prints one line per query
/// whose result differs from the published answer.
void print_queries(const std::vector<QueryFileResult>& files, bool verified, bool list_false) {
  std::size_t width = 20;
  for (const QueryFileResult& file : files) width = std::max(width, one_line(file.path).size());
  fmt::print("{:<{}} {:>11} {:>11} {:>15} {:>15} {:>10}\n", "file", width, "queries", "touching",
             "false negatives", "false positives", "ns/query");
  for (const QueryFileResult& file : files)
    print_row(width, one_line(file.path), Totals({&file, 1}), file.compared);
  const Totals all(files);
  if (files.size() > 1) print_row(width, "total", all, all.compared > 0);
  fmt::print("\n");
  print_comparison(all);
  if (all.within_tolerance > 0)
    fmt::print("{} within tolerance only: floating point cannot decide whether they touch\n",
               counted(all.within_tolerance, "query is", "queries are"));
  if (verified)
    fmt::print("verified: {} by algebra, {}\n", counted(all.queries, "query", "queries"),
               all.differences == 0 ? "no difference" : counted(all.differences, "difference"));
  for (const QueryFileResult& file : files) {
    if (list_false) print_false(file);
    print_differences(file);
  }
}

/// Writes the JSON that docs/json.md describes.
void write_queries(JsonWriter& json, const std::vector<QueryFileResult>& files,
                   const CcdQueriesOptions& options) {
  json.member("min_separation", options.impact.min_separation);
  json.objects("files", files, [&](const QueryFileResult& file) {
    json.member("file", file.path);
    json.member("kind", word_of(file.kind));
    json.member("queries", std::uint64_t{file.times.size()});
    json.member("touching", file.touching);
    json.member("within_tolerance", file.within_tolerance);
    json.member("compared", file.compared);
    json.list("false_negatives", file.false_negatives);
    json.list("false_positives", file.false_positives);
    json.list("times", file.times,
              [&](const std::optional<double>& time) { time ? json.value(*time) : json.null(); });
    if (options.verify) write_differences(json, file.differences);
    if (options.json_stats) json.member("seconds_per_query", file.seconds_per_query);
  });
  const Totals all(files);
  json.object("total", [&] {
    json.member("queries", all.queries);
    json.member("touching", all.touching);
    json.member("within_tolerance", all.within_tolerance);
    json.member("compared", all.compared);
    json.member("false_negatives", all.false_negatives);
    json.member("false_positives", all.false_positives);
    if (options.verify) json.member("differences", all.differences);
    if (options.json_stats) json.member("seconds_per_query", all.seconds_per_query());
  });
}

}  // namespace

int run_ccd_queries(const CcdQueriesOptions& options) {
  const std::vector<QueryPaths> paths = paths_of(options);
  std::uint64_t bytes = 1, bytes_done = 0;
  for (const QueryPaths& p : paths) bytes += p.bytes;
  std::optional<JsonWriter> json;
  if (!options.json.empty()) json.emplace(options.json);
  std::vector<QueryFileResult> results;
  {
    Progress progress(bytes, !options.quiet);
    for (const QueryPaths& p : paths) {
      results.push_back(answer_file(p, options, progress, bytes_done));
      bytes_done += p.bytes;
    }
  }
  if (json) {
    write_queries(*json, results, options);
    json->close();
  }
  if (!options.quiet && options.json != "-") print_queries(results, options.verify, options.list_false);
  const Totals all(results);
  return all.false_answers() + all.differences == 0 ? exit_done : exit_differences;
}

}  // namespace supple::cli
