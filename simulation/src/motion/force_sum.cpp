#include "motion/force_sum.hpp"

#include <algorithm>

#include "motion/element_forces.hpp"

namespace supple {
namespace {

struct Motion {
  const Vec3d* positions;
  const Vec3d* velocities;
};

void add_springs(const ElementBlocks<SpringElement>& springs, std::uint32_t block, double stiffness,
                 double damping, Motion motion, Vec3d* in_block, Vec3d* crossing) {
  const auto force = [&](const SpringElement& spring) {
    return spring_force(motion.positions[spring.b] - motion.positions[spring.a],
                        motion.velocities[spring.b] - motion.velocities[spring.a], stiffness, damping,
                        spring.rest_length);
  };
  for (std::uint32_t i = springs.first[block]; i < springs.first_crossing[block]; ++i) {
    const SpringElement& spring = springs.elements[i];
    const Vec3d f = force(spring);
    in_block[spring.a] = in_block[spring.a] + f;
    in_block[spring.b] = in_block[spring.b] - f;
  }
  const std::uint32_t* slot = springs.slots.data() + springs.first_slot[block];
  for (std::uint32_t i = springs.first_crossing[block]; i < springs.first[block + 1]; ++i, slot += 2) {
    const Vec3d f = force(springs.elements[i]);
    crossing[slot[0]] = f;
    crossing[slot[1]] = Vec3d{} - f;
  }
}

void add_areas(const ElementBlocks<AreaElement>& areas, std::uint32_t block, double stiffness,
               const Vec3d* positions, Vec3d* in_block, Vec3d* crossing) {
  const auto forces = [&](const AreaElement& area) {
    const Triangle& t = area.corners;
    return area_forces(area, stiffness, positions[t[0]], positions[t[1]], positions[t[2]]);
  };
  for (std::uint32_t i = areas.first[block]; i < areas.first_crossing[block]; ++i) {
    const auto f = forces(areas.elements[i]);
    for (int corner = 0; corner < 3; ++corner) {
      Vec3d& sum = in_block[areas.elements[i].corners[corner]];
      sum = sum + f[corner];
    }
  }
  const std::uint32_t* slot = areas.slots.data() + areas.first_slot[block];
  for (std::uint32_t i = areas.first_crossing[block]; i < areas.first[block + 1]; ++i, slot += 3) {
    const auto f = forces(areas.elements[i]);
    for (int corner = 0; corner < 3; ++corner) crossing[slot[corner]] = f[corner];
  }
}

/// A third of the pressure force on a triangle acts on each corner.
void add_volumes(const ElementBlocks<VolumeElement>& volumes, std::uint32_t block,
                 std::span<const double> pressures, const Vec3d* positions, Vec3d* in_block,
                 Vec3d* crossing) {
  const auto force = [&](const VolumeElement& element) {
    const Triangle& t = element.corners;
    return area_vector(positions[t[0]], positions[t[1]], positions[t[2]]) * (pressures[element.part] / 3);
  };
  for (std::uint32_t i = volumes.first[block]; i < volumes.first_crossing[block]; ++i) {
    const Vec3d f = force(volumes.elements[i]);
    for (const std::uint32_t corner : volumes.elements[i].corners) in_block[corner] = in_block[corner] + f;
  }
  const std::uint32_t* slot = volumes.slots.data() + volumes.first_slot[block];
  for (std::uint32_t i = volumes.first_crossing[block]; i < volumes.first[block + 1]; ++i, slot += 3) {
    const Vec3d f = force(volumes.elements[i]);
    for (int corner = 0; corner < 3; ++corner) crossing[slot[corner]] = f;
  }
}

}  // namespace

VolumeSum::VolumeSum(const SpringNetwork& network)
    : of_runs_(network.runs.size()), of_parts_(network.parts.size()) {}

void VolumeSum::compute(const SpringNetwork& network, std::span<const Vec3d> positions,
                        const Parallel& parallel) {
  const std::span<const VolumeElement> elements = network.volumes.elements;
  parallel.for_ranges(network.runs.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const VolumeRun& run = network.runs[i];
      of_runs_[i] = volume_of(elements.subspan(run.first, run.last - run.first),
                              positions[network.parts[run.part].origin], positions);
    }
  });
  std::fill(of_parts_.begin(), of_parts_.end(), 0.0);
  for (std::size_t i = 0; i < network.runs.size(); ++i) of_parts_[network.runs[i].part] += of_runs_[i];
}

ForceSum::ForceSum(const SpringNetwork& network)
    : in_block_(network.vertex_count),
      crossing_(network.first_slot.back()),
      volumes_(network),
      pressures_(network.parts.size()) {}

void ForceSum::compute(const SpringNetwork& network, const MassSpringOptions& options,
                       std::span<const Vec3d> positions, std::span<const Vec3d> velocities,
                       const Parallel& parallel) {
  const Motion motion{positions.data(), velocities.data()};
  volumes_.compute(network, positions, parallel);
  for (std::size_t part = 0; part < pressures_.size(); ++part) {
    pressures_[part] =
        -options.volume_stiffness * volumes_.growth(network, part) * network.parts[part].inverse_scale;
  }
  parallel.for_ranges(network.block_count(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (auto block = static_cast<std::uint32_t>(begin); block < end; ++block) {
      const std::uint32_t first = block * vertex_block_size;
      const std::uint32_t last = std::min(first + vertex_block_size, network.vertex_count);
      std::fill(in_block_.begin() + first, in_block_.begin() + last, Vec3d{});
      add_springs(network.edges, block, options.stiffness, options.damping, motion, in_block_.data(),
                  crossing_.data());
      add_springs(network.bending, block, options.bending_stiffness, options.damping, motion,
                  in_block_.data(), crossing_.data());
      add_areas(network.areas, block, options.area_stiffness, motion.positions, in_block_.data(),
                crossing_.data());
      add_volumes(network.volumes, block, pressures_, motion.positions, in_block_.data(), crossing_.data());
    }
  });
}

}  // namespace supple
