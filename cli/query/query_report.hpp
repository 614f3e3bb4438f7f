#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/json_writer.hpp"
#include "query/query_file.hpp"
#include "supple/result.hpp"
#include "supple/verify.hpp"

namespace supple::cli {

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

  std::uint64_t false_answers() const { return false_negatives.size() + false_positives.size(); }
};

/// Prints a table with one row per file and a total. With `list_false`, it also prints one line per query
/// whose result differs from the published answer.
void print_queries(const std::vector<QueryFileResult>& files, bool verified, bool list_false);

/// Writes the JSON that docs/json.md describes, file by file.
class QueryJsonReport {
 public:
  QueryJsonReport(const std::string& file_name, double min_separation, bool with_stats, bool verified);

  void add(const QueryFileResult& file);
  void finish(const std::vector<QueryFileResult>& files);

 private:
  JsonWriter json_;
  bool with_stats_, verified_;
};

}  // namespace supple::cli
