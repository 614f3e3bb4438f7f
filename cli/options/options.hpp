#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "inputs/reading.hpp"
#include "options/option_needs.hpp"
#include "query/query_file.hpp"
#include "session/overrides.hpp"
#include "session/session.hpp"
#include "supple/option_descriptions.hpp"

namespace CLI {
class App;
}

namespace supple::cli {

struct Dependence;

/// Questions of `supple query`.
enum class SceneQuery : std::uint8_t { closest, inside, rays, distance };

}  // namespace supple::cli

template <>
inline constexpr std::array supple::words<supple::cli::SceneQuery>{"closest", "inside", "rays", "distance"};

namespace supple::cli {

/// The method that finds contacts.
struct MethodOptions {
  SceneOptions scene;    ///< the options of the input or the defaults, replaced by the given options
  bool as_2007 = false;  ///< the method of the paper's program, which given options change
  std::optional<bool> fused_refit{};  ///< as given; after all options were read, what applies
  bool root_is_border = false;        ///< the root of the scene octree is given as the border of the scene
  viewer::Overrides<SceneOptions> given_scene{default_scene_options()};
  viewer::Overrides<ObjectOptions> given_objects;  ///< of all objects
  bool parts = false;                              ///< each connected part is an object
};

/// What a command reads.
struct InputOptions {
  std::vector<std::string> inputs;  ///< meshes, patterns, or one scene file or recording
  bool sequence = false;            ///< the inputs are frames of one object
  MeshReading reading;
};

/// What ends a run before it is complete. The results so far are written and marked as truncated.
struct RunLimits {
  std::uint64_t max_contacts = std::numeric_limits<std::uint64_t>::max();
  std::optional<double> seconds{};  ///< of wall-clock time, without reading the input
};

/// The numbers of two objects whose descent in the narrow phase is reported (Figure 4 of the paper).
using ObjectNumbers = std::array<std::uint32_t, 2>;

/// Optional parts of the JSON; `contact_details` also of the CSV.
struct JsonContent {
  /// Options, and the times and counts of each frame: the parts that may differ between two runs with the
  /// same results.
  bool stats = true;
  bool contact_details = false;               ///< points, normals and barycentric coordinates of each contact
  bool faces = false;                         ///< the triangles of each object
  std::optional<ObjectNumbers> node_pairs{};  ///< the objects whose colliding nodes are written
};

/// The options of all commands that find and report contacts.
struct DetectionOptions : MethodOptions {
  RunLimits limits;
  bool verify = false;
  bool fail_on_contact = false;
  bool quiet = false;
  JsonContent json_content;
  std::string json, csv;  ///< empty: none; "-": standard output
};

/// Options of `supple detect`.
struct DetectOptions : DetectionOptions, InputOptions {
  std::optional<std::uint64_t> frames;
};

/// Options of `supple simulate`.
struct SimulateOptions : DetectionOptions {
  std::string input;  ///< a scene file
  std::optional<std::uint64_t> frames;
  std::optional<double> seconds;  ///< simulated; excludes `frames`
  std::optional<std::uint64_t> seed;
  std::optional<double> time_step;
  std::string record;  ///< a file; empty: none
};

/// Options of `supple view`.
struct ViewOptions : MethodOptions, InputOptions {
  std::optional<std::uint64_t> seed;
  std::optional<double> time_step;
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any free port
  std::string token_file;  ///< empty: a new token in each run
  bool open_browser = true;
  viewer::MemoryBudget budget;
  bool has_spectators = false;  ///< pages that may only watch
  bool follow = false;          ///< a recording that is still being written
  std::string compared;         ///< a recording to compare with; empty: none
  double tolerance = 0;         ///< of that comparison, in units of length
  std::string page_file;        ///< file to write instead of serving; empty: serve
  std::string view_file;        ///< camera, layers and colours; empty: those of the page
};

/// The largest width and height of a picture.
inline constexpr std::uint32_t most_pixels = 16384;

/// Frames from the first to the last, every n-th.
struct FrameRange {
  std::uint64_t first = 0, last = 0, every = 1;

  std::uint64_t count() const { return (last - first) / every + 1; }
};

/// Options of `supple render`.
struct RenderOptions : ViewOptions {
  struct Size {
    double width = 1600, height = 1200;
    bool is_in_millimetres = false;  ///< otherwise in pixels
  };

  std::string output;                  ///< a file, or a pattern of files with the number of the frame
  bool is_svg = false;                 ///< otherwise PNG
  std::optional<FrameRange> frames{};  ///< nothing: the frame of the view file, or 0
  Size size;
  double dpi = 200;
  std::string background = "white", theme = "light";
  bool legend = false, scale_bar = false, colour_bar = false;
  std::string plot;     ///< name of a plot to draw instead of the scene; empty for none
  std::string browser;  ///< path of a Chromium; empty: `find_browser` looks for one
  bool uses_graphics_card = false;
  bool quiet = false;
};

/// Options of `supple info`.
struct InfoOptions {
  std::vector<std::string> inputs;
  CoordinateConversion conversion;
  viewer::Overrides<SceneOptions> given_scene;  ///< only the bounding volume
  viewer::Overrides<ObjectOptions> given_objects;
  bool as_2007 = false;  ///< octrees of the paper's program, which given options change
  bool parts = false;    ///< each connected part is an object
  std::string json;
};

/// Options of `supple query`.
struct QueryOptions {
  SceneQuery kind = SceneQuery::closest;
  std::string file;                 ///< of points or rays; none for distances
  std::vector<std::string> inputs;  ///< meshes, patterns, or one scene file or recording
  CoordinateConversion conversion;
  viewer::Overrides<SceneOptions> given_scene;     ///< only the number of threads
  viewer::Overrides<ObjectOptions> given_objects;  ///< only welding
  bool parts = false;                              ///< each connected part is an object
  RunLimits limits;
  double max_distance = std::numeric_limits<double>::infinity();
  bool signed_distance = false;
  bool all_hits = false;
  bool verify = false;
  bool quiet = false;
  std::string json;
};

/// Options of `supple ccd-queries`.
struct CcdQueriesOptions {
  std::vector<std::string> inputs;   ///< query files or patterns
  std::vector<std::string> answers;  ///< none, or one for each query file
  std::optional<QueryKind> kind;     ///< without a value: from the paths
  ImpactOptions impact;
  bool verify = false;
  bool list_false = false;
  bool quiet = false;
  bool json_stats = true;
  std::string json;
};

/// Options of `supple diff`.
struct DiffOptions {
  std::vector<std::string> recordings;  ///< two
  double tolerance = 0;
  bool quiet = false;
  std::string json;
};

struct CommandLine {
  enum class Command { detect, simulate, view, render, info, query, ccd_queries, diff, experiment, exit };
  Command command = Command::exit;
  int exit_status = 0;  ///< of `Command::exit`: help, version or a usage error, already printed
  DetectOptions detect;
  SimulateOptions simulate;
  ViewOptions view;
  RenderOptions render;
  InfoOptions info;
  QueryOptions query;
  CcdQueriesOptions ccd_queries;
  DiffOptions diff;
};

/// Prints help, version and generated documents to standard output, and a usage error as one line to standard
/// error. The program of the experiments adds their options to the command `experiment`.
CommandLine parse_command_line(
    int argument_count, const char* const* arguments,
    const std::function<void(CLI::App& experiment, std::vector<Dependence>& dependences)>& add_options = {});

}  // namespace supple::cli
