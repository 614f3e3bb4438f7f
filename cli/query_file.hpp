#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "supple/continuous.hpp"
#include "supple/description.hpp"

namespace supple::cli {

enum class QueryKind : std::uint8_t { vertex_face, edge_edge };

}  // namespace supple::cli

template <>
inline constexpr std::array supple::words<supple::cli::QueryKind>{"vertex-face", "edge-edge"};

namespace supple::cli {

/// Queries of one kind, and the answers to them where they are known.
struct QueryFile {
  std::filesystem::path path;
  std::variant<std::vector<VertexFaceMotion>, std::vector<EdgeEdgeMotion>> queries;
  std::optional<std::vector<bool>> answers;  ///< one a query: do the elements touch?

  std::size_t size() const {
    return std::visit([](const auto& motions) { return motions.size(); }, queries);
  }
};

/// The kind that a path tells: the innermost folder named `vertex-face` or `edge-edge`, or the ending `vf` or
/// `ee` of the file's stem. Throws `Error` when it tells none or both.
QueryKind kind_of(const std::filesystem::path& path);

/// Reads queries in the format of the Sample-Queries data set: eight rows a query, the four vertices at the
/// start of the step and then at its end; a row is numerator,denominator of x, y and z, and perhaps the
/// answer, 0 or 1. Throws `Error` that names file, line and value and says what is allowed.
QueryFile read_query_file(const std::filesystem::path& path, QueryKind kind);

/// Takes the answers from a JSON list of true and false, one a query. Throws `Error` likewise.
void read_answers(const std::filesystem::path& path, QueryFile& file);

}  // namespace supple::cli
