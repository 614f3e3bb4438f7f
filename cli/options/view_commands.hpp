#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>

#include "options/option_kinds.hpp"
#include "options/options.hpp"

// The commands that draw a scene: `supple view` and `supple render`.
namespace supple::cli {

/// Adds options that replace values of the scene file.
void add_scene_overrides(CLI::App& app, std::optional<std::uint64_t>& seed, std::optional<double>& time_step);
CLI::App* add_view(CLI::App& program, ViewOptions& options, Dependences& dependences);
CLI::App* add_render(CLI::App& program, RenderOptions& options, Dependences& dependences);

}  // namespace supple::cli
