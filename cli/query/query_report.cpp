#include "query/query_report.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "base/text.hpp"
#include "supple/difference_descriptions.hpp"
#include "supple/result_descriptions.hpp"

namespace supple::cli {
namespace {

/// Sums over all files.
struct Totals {
  std::uint64_t queries = 0, touching = 0, within_tolerance = 0, compared = 0;
  std::uint64_t false_negatives = 0, false_positives = 0, differences = 0;
  double seconds = 0;

  explicit Totals(const std::vector<QueryFileResult>& files) {
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

  double seconds_per_query() const {
    return seconds / static_cast<double>(std::max<std::uint64_t>(queries, 1));
  }
};

void print_row(std::size_t width, const std::string& name, std::uint64_t queries, std::uint64_t touching,
               bool compared, std::uint64_t false_negatives, std::uint64_t false_positives, double seconds) {
  const auto count = [&](std::uint64_t number) { return compared ? grouped(number) : std::string("-"); };
  fmt::print("{:<{}} {:>11} {:>11} {:>15} {:>15} {:>10.0f}\n", name, width, grouped(queries),
             grouped(touching), count(false_negatives), count(false_positives), 1e9 * seconds);
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
  const std::uint64_t wrong = all.false_negatives + all.false_positives;
  if (all.queries == 0) {
    fmt::print("There are no queries.\n");
  } else if (all.compared == 0) {
    fmt::print("There are no answers to compare with.\n");
  } else {
    fmt::print("{} compared with answers, {}\n", counted(all.compared, "query", "queries"),
               wrong == 0 ? "none is false" : counted(wrong, "is false", "are false"));
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

}  // namespace

void print_queries(const std::vector<QueryFileResult>& files, bool verified, bool list_false) {
  std::size_t width = 20;
  for (const QueryFileResult& file : files) width = std::max(width, one_line(file.path).size());
  fmt::print("{:<{}} {:>11} {:>11} {:>15} {:>15} {:>10}\n", "file", width, "queries", "touching",
             "false negatives", "false positives", "ns/query");
  for (const QueryFileResult& file : files)
    print_row(width, one_line(file.path), file.times.size(), file.touching, file.compared,
              file.false_negatives.size(), file.false_positives.size(), file.seconds_per_query);
  const Totals all(files);
  if (files.size() > 1)
    print_row(width, "total", all.queries, all.touching, all.compared > 0, all.false_negatives,
              all.false_positives, all.seconds_per_query());
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

QueryJsonReport::QueryJsonReport(const std::string& file_name, double min_separation, bool with_stats,
                                 bool verified)
    : json_(file_name), with_stats_(with_stats), verified_(verified) {
  json_.member("min_separation", min_separation);
  json_.key("files");
  json_.begin_array();
}

void QueryJsonReport::add(const QueryFileResult& file) {
  json_.begin_object();
  json_.member("file", file.path);
  json_.member("kind", word_of(file.kind));
  json_.member("queries", std::uint64_t{file.times.size()});
  json_.member("touching", file.touching);
  json_.member("within_tolerance", file.within_tolerance);
  json_.member("compared", file.compared);
  json_.list("false_negatives", file.false_negatives);
  json_.list("false_positives", file.false_positives);
  json_.list("times", file.times,
             [&](const std::optional<double>& time) { time ? json_.value(*time) : json_.null(); });
  if (verified_) write_differences(json_, file.differences);
  if (with_stats_) json_.member("seconds_per_query", file.seconds_per_query);
  json_.end_object();
  json_.flush();
}

void QueryJsonReport::finish(const std::vector<QueryFileResult>& files) {
  const Totals all(files);
  json_.end_array();
  json_.object("total", [&] {
    json_.member("queries", all.queries);
    json_.member("touching", all.touching);
    json_.member("within_tolerance", all.within_tolerance);
    json_.member("compared", all.compared);
    json_.member("false_negatives", all.false_negatives);
    json_.member("false_positives", all.false_positives);
    if (verified_) json_.member("differences", all.differences);
    if (with_stats_) json_.member("seconds_per_query", all.seconds_per_query());
  });
  json_.close();
}

}  // namespace supple::cli
