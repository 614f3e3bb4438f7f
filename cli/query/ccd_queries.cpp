#include "query/ccd_queries.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "base/exit_status.hpp"
#include "base/output_names.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "query/query_report.hpp"
#include "supple/error.hpp"
#include "supple/verify.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

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
    throw Error(fmt::format("--answers: {} for {}; give one for each, in the same order",
                            counted(answers.size(), "file"),
                            counted(queries.size(), "query file", "query files")));
  std::vector<QueryPaths> paths;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (!fs::exists(queries[i]))
      throw Error(
          fmt::format("{}: there is no such file; check the folder and the spelling", queries[i].string()));
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

/// Answers the queries of one file and shows the progress.
class CcdRun {
 public:
  CcdRun(const CcdQueriesOptions& options, Progress& progress) : options_(options), progress_(progress) {}

  QueryFileResult of(const QueryPaths& paths);

 private:
  template <class Motion>
  void answer(const std::vector<Motion>& queries, const QueryPaths& paths, QueryFileResult& result);

  const CcdQueriesOptions& options_;
  Progress& progress_;
  std::uint64_t bytes_done_ = 0;
};

QueryFileResult CcdRun::of(const QueryPaths& paths) {
  QueryFileResult result;
  result.path = paths.queries.string();
  result.kind = options_.kind ? *options_.kind : kind_of(paths.queries);
  QueryFile file = read_query_file(paths.queries, result.kind);
  if (!paths.answers.empty()) read_answers(paths.answers, file);
  std::visit([&](const auto& queries) { answer(queries, paths, result); }, file.queries);
  result.compared = file.answers.has_value();
  for (std::size_t i = 0; result.compared && i < file.size(); ++i) {
    if (result.times[i].has_value() == (*file.answers)[i]) continue;
    (result.times[i] ? result.false_positives : result.false_negatives).push_back(i);
  }
  bytes_done_ += paths.bytes;
  return result;
}

template <class Motion>
void CcdRun::answer(const std::vector<Motion>& queries, const QueryPaths& paths, QueryFileResult& result) {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const std::optional<Impact> impact = first_impact(queries[i], options_.impact);
    result.times.push_back(impact ? std::optional(impact->toi) : std::nullopt);
    result.touching += impact ? 1 : 0;
    result.within_tolerance += impact && impact->certainty == ImpactCertainty::within_tolerance ? 1 : 0;
    if (options_.verify) {
      const auto truth = first_contact_by_algebra(queries[i], options_.impact.min_separation);
      if (const auto fault = fault_of(impact, truth))
        result.differences.push_back({i, *fault, result.times[i], truth});
    }
    progress_.update(bytes_done_ + paths.bytes * i / queries.size(),
                     fmt::format("query {} of {} in {}", i, queries.size(), paths.queries.string()));
  }
  result.seconds_per_query = measure_seconds_per_query(queries, options_.impact);
}

}  // namespace

int run_ccd_queries(const CcdQueriesOptions& options) {
  const std::vector<QueryPaths> paths = paths_of(options);
  std::uint64_t bytes = 1;
  for (const QueryPaths& p : paths) bytes += p.bytes;
  std::optional<QueryJsonReport> json;
  if (!options.json.empty())
    json.emplace(options.json, options.impact.min_separation, options.json_stats, options.verify);

  std::vector<QueryFileResult> results;
  {
    Progress progress(bytes, !options.quiet);
    CcdRun run(options, progress);
    for (const QueryPaths& p : paths) {
      results.push_back(run.of(p));
      if (json) json->add(results.back());
    }
  }
  if (json) json->finish(results);
  if (!options.quiet && options.json != "-") print_queries(results, options.verify, options.list_false);
  const bool faultless = std::all_of(results.begin(), results.end(), [](const QueryFileResult& result) {
    return result.false_answers() == 0 && result.differences.empty();
  });
  return faultless ? exit_done : exit_differences;
}

}  // namespace supple::cli
