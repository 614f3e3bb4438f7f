#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>

#include "options/option_kinds.hpp"
#include "options/options.hpp"

// Options that several commands have.
namespace supple::cli {

/// Welding, where objects are not tested for contacts.
void add_weld(CLI::App& app, viewer::Overrides<ObjectOptions>& objects);
CLI::Option* add_max_contacts(CLI::App& app, RunLimits& limits, const char* description);
CLI::Option* add_time_limit(CLI::App& app, RunLimits& limits);
/// Adds the options of the octree of each object, and those of its contacts when objects are tested.
void add_object_options(CLI::App& app, viewer::Overrides<ObjectOptions>& objects, bool are_tested);
void add_parts(CLI::App& app, bool& parts, const char* group);
CLI::Option* add_frames(CLI::App& app, std::optional<std::uint64_t>& frames, const char* description);
void add_conversion(CLI::App& app, CoordinateConversion& conversion);
/// Adds the inputs: meshes, a scene file, a recording, or frames.
void add_input_options(CLI::App& app, InputOptions& options);
/// Adds every option of the detection. A page has a layer instead of `--colliding-vertices`.
void add_detection_options(CLI::App& app, MethodOptions& options, Dependences& dependences,
                           bool of_page = false);
/// For commands whose scenes have masses and springs.
void add_fused_refit(CLI::App& app, MethodOptions& options, Dependences& dependences);
void add_report_options(CLI::App& app, DetectionOptions& options, Dependences& dependences);
void add_output_options(CLI::App& app, DetectionOptions& options, Dependences& dependences);

/// Adds options that replace values of the scene file.
void add_scene_overrides(CLI::App& app, std::optional<std::uint64_t>& seed, std::optional<double>& time_step);

// The commands that draw a scene.
void add_view(CLI::App& program, ViewOptions& options, Dependences& dependences);
void add_render(CLI::App& program, RenderOptions& options, Dependences& dependences);

/// Prints as JSON what tools/make_documents.py makes documents from: the commands and their options, and the
/// options, records, statistics, messages and view files by their descriptions.
void describe_program(const CLI::App& program);

}  // namespace supple::cli
