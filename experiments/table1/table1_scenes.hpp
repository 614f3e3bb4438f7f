#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "inputs/inputs.hpp"
#include "table1/table1_options.hpp"

namespace supple::experiments {

/// A scene file built into the program.
struct SceneText {
  const char* name;  ///< of the file, without its ending
  const char* text;
};

/// Generated from scenes/ when the program is built: `table1_3`, `three_humans`, `three_bikes` and `nine`.
std::span<const SceneText> table1_scene_texts();

/// Whether the program contains a scene with this name.
bool is_built_in(std::string_view name);

/// Reads or makes a scene. Run `seed` differs from other runs by the random numbers of the motion.
///
/// A mixed scene has the pawn, the fish and the rabbit of `table1_3` several times, in a row for each model
/// as in scenes/table1_6.toml and scenes/table1_9.toml, and in several rows from ten objects on. The border
/// is that of `table1_3`, or larger when the objects do not fit.
///
/// Throws `Error` when the file is unusable, when objects start outside the cube of the given size, or when
/// size or integrator have no effect on the scene.
cli::Input read_scene(const Table1Scene& scene, std::optional<Integrator> integrator, std::uint64_t seed);

/// The longest edge of the border; none when the scene has no border.
std::optional<double> edge_of(const cli::Input& input);

}  // namespace supple::experiments
