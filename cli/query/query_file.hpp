#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "supple/continuous.hpp"
#include "supple/description.hpp"
#include "supple/queries.hpp"

namespace supple::cli {

enum class QueryKind : std::uint8_t { vertex_face, edge_edge };

}  // namespace supple::cli

template <>
inline constexpr std::array supple::words<supple::cli::QueryKind>{"vertex-face", "edge-edge"};

namespace supple::cli {

/// Queries of one kind, and their answers when they are known.
struct QueryFile {
  std::filesystem::path path;
  std::variant<std::vector<VertexFaceMotion>, std::vector<EdgeEdgeMotion>> queries;
  std::optional<std::vector<bool>> answers;  ///< for each query: whether the elements touch

  std::size_t size() const {
    return std::visit([](const auto& motions) { return motions.size(); }, queries);
  }
};

/// The kind from a path: the innermost folder named `vertex-face` or `edge-edge`, or the ending `vf` or `ee`
/// of the file's stem. Throws `Error` when the path gives no kind or both.
QueryKind kind_of(const std::filesystem::path& path);

/// Reads queries in the format of the Sample-Queries data set: eight rows per query, with the four vertices
/// at the start of the step and then at its end. A row has numerator,denominator of x, y and z, and
/// optionally the answer, 0 or 1. Throws `Error`; the message names the file, the line and the value, and
/// says what is allowed.
QueryFile read_query_file(const std::filesystem::path& path, QueryKind kind);

/// Reads the answers from a JSON list of true and false, one per query. Throws `Error` in the same way.
void read_answers(const std::filesystem::path& path, QueryFile& file);

/// Reads points, three numbers a line, or rays, six numbers a line: the origin and the direction. Blanks,
/// tabs or commas separate the numbers. Empty lines, and what follows a #, are left out. Throws `Error` when
/// a line has another number of numbers; the message names the file, the line and the text.
std::vector<Vec3d> read_points(const std::filesystem::path& path);
std::vector<Ray> read_rays(const std::filesystem::path& path);

}  // namespace supple::cli
