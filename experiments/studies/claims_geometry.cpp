#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/text.hpp"
#include "fit.hpp"
#include "judgement.hpp"
#include "studies/box_field.hpp"
#include "studies/claims.hpp"
#include "supple/models.hpp"

namespace supple::experiments {

/// Sections 5 and 7: regions of a level of the scene octree, which are as large as the objects or larger.
Finding regions_of_objects(const ClaimsOptions& options) {
  constexpr std::size_t most = 8;
  const BoxField field(options.spheres, options.seed);
  constexpr float edge = 1;  // of a region; no box is longer
  std::array<std::uint64_t, most + 1> with{};
  for (const Aabb& box : field.boxes()) {
    std::size_t regions = 1;
    for (int axis = 0; axis < 3; ++axis)
      regions *= std::floor(box.min[axis] / edge) == std::floor(box.max[axis] / edge) ? 1 : 2;
    ++with[regions];
  }
  Finding finding{
      {"regions-of-an-object", "5",
       "“The same object can be placed in one, two or four regions at the same time”."},
      {"claims_object_regions",
       "Boxes by the number of regions that they overlap, with regions as long as the longest box",
       {{"regions", "Regions"}, {"boxes", "Boxes"}}}};
  for (std::size_t regions = 1; regions <= most; regions *= 2)
    finding.table.add({std::uint64_t{regions}, with[regions]});
  const double share = static_cast<double>(with[most]) / static_cast<double>(options.spheres);
  finding.claim.verdict = verdict_of(with[most] == 0);
  finding.claim.number =
      Estimate{100 * share, 100 * std::sqrt(share * (1 - share) / static_cast<double>(options.spheres))};
  finding.claim.quantity = "% of the boxes in eight regions";
  finding.claim.reason =
      fmt::format("A box around a corner of the regions is in eight. Of {} random boxes, {:.1f} % are.",
                  cli::grouped(options.spheres), 100 * share);
  return finding;
}

/// Section 5: a statement that needs no measurement.
Finding leaves_of_levels(const ClaimsOptions&) {
  Finding finding{{"levels", "5",
                   "“level-allowed = 2 when there are 64 leaves, 4 when there are 512 leaves, and so on”."},
                  {"claims_levels", "Leaves of a full octree", {{"level", "Level"}, {"leaves", "Leaves"}}}};
  std::uint64_t leaves = 1, level = 0;
  for (; level < 4; ++level, leaves *= 8) finding.table.add({level, leaves});
  finding.table.add({level, leaves});
  finding.claim.verdict = verdict_of(leaves == 512);
  finding.claim.number = Estimate{static_cast<double>(leaves), NAN};
  finding.claim.quantity = "leaves of a full octree of level 4";
  finding.claim.reason =
      "Level 2 has 8² = 64 leaves; 512 = 8³ leaves are those of level 3, and level 4 has 4,096.";
  return finding;
}

/// Section 5.1: the sphere of eq. 3 and 4, and that of eq. 5, around the models of the paper.
Finding spheres_of_the_equations(const ClaimsOptions&) {
  Finding finding{{"large-spheres", "5.1",
                   "The sphere of eq. 3 and 4 “is too large for the object”; that of eq. 5 “is more "
                   "accurate”. Read as: its "
                   "radius is larger than that of eq. 5."},
                  {"claims_spheres",
                   "Spheres around the models",
                   {{"model", "Model"},
                    {"radius_box", "Radius of eq. 4"},
                    {"radius_vertices", "of eq. 5"},
                    {"ratio", "Ratio"},
                    {"outside", "Vertices outside of eq. 3 and 4"},
                    {"vertices", "Vertices"}}}};
  std::vector<double> ratios;
  std::uint64_t outside_all = 0, vertices = 0;
  for (const char* const model : {"pawn", "fish", "rabbit", "human", "bike"}) {
    const std::vector<Vec3d> positions = make_model(model).positions;
    Vec3d low = positions.front(), high = low;
    for (const Vec3d& p : positions) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    }
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, high[axis] - low[axis]);
    const double of_box = longest / 2;
    const Vec3d center_of_box = low + Vec3d{of_box, of_box, of_box};
    double of_vertices = 0;
    std::uint64_t outside = 0;
    for (const Vec3d& p : positions) {
      const Vec3d d = p - (low + high) * 0.5, e = p - center_of_box;
      of_vertices = std::max(of_vertices, std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z));
      outside += std::sqrt(e.x * e.x + e.y * e.y + e.z * e.z) > of_box;
    }
    ratios.push_back(of_box / of_vertices);
    outside_all += outside;
    vertices += positions.size();
    finding.table.add({model, of_box, of_vertices, ratios.back(), outside, std::uint64_t{positions.size()}});
  }
  const Estimate ratio = estimate_of(ratios);
  finding.claim.verdict = above(ratio, 1);
  finding.claim.number = ratio;
  finding.claim.quantity = "radius of eq. 4 / of eq. 5, mean of five models";
  finding.claim.reason = fmt::format(
      "Around the five models the radius of eq. 4 is {} times that of eq. 5. It is half of the longest edge "
      "of "
      "the box, around a centre that is not that of the box, so {} of {} vertices are outside: it is too "
      "small "
      "where the object ends, and too large along the short edges.",
      text_of(ratio), cli::grouped(outside_all), cli::grouped(vertices));
  return finding;
}

}  // namespace supple::experiments
