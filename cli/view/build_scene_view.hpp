#pragma once

#include <string>

#include "base/files.hpp"
#include "options/options.hpp"
#include "session/scene_view.hpp"

namespace supple::cli {

/// Throws `Error` in a build without the viewer.
void check_viewer();

/// The page, with the view of the view file. Throws `Error` when that cannot be read.
std::string page_of(const ViewOptions& options);

/// Reads the input of a command that shows it, prints notes on it, and makes its scene view: a simulation, or
/// frames when a recording or files move the objects. Reads all data of the frames of a recording except
/// positions and contacts. The input is not kept: a recording that grows must have no other owner. Throws
/// `Error` when the input cannot be read, when `output` or the view file is an input, for options that have
/// no effect on this input, and when files move some objects and masses and springs move others.
viewer::SceneView read_scene_view(const ViewOptions& options, const OutputName& output);

/// Prints what can never touch.
void print_warnings(const viewer::SceneView& show);

}  // namespace supple::cli
