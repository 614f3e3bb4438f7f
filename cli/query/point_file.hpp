#pragma once

#include <filesystem>
#include <vector>

#include "supple/queries.hpp"

namespace supple::cli {

/// Reads points, three numbers a line, or rays, six numbers a line: the origin and the direction. Blanks,
/// tabs or commas separate the numbers. Empty lines, and what follows a #, are left out. Throws `Error` when
/// a line has another number of numbers; the message names the file, the line and the text.
std::vector<Vec3d> read_points(const std::filesystem::path& path);
std::vector<Ray> read_rays(const std::filesystem::path& path);

}  // namespace supple::cli
