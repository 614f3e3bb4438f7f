#include "commands/commands.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/interruption.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "export/embedded.hpp"
#include "export/page_file.hpp"
#include "server/access.hpp"
#include "server/browser_visit.hpp"
#include "server/server.hpp"
#include "session/packed/packed_scene.hpp"
#include "session/session.hpp"
#include "view/build_scene_view.hpp"
#include "view_file/view_file.hpp"

namespace supple::cli {
namespace {

/// The size in bytes of the frames in a page before compression: positions as floats.
double size_of_frames(const viewer::SceneView& show) {
  if (!show.frames) return 0;
  double vertices = 0;
  for (const viewer::ViewedObject& object : show.objects) {
    if (!object.options.is_static) vertices += static_cast<double>(object.mesh.positions.size());
  }
  return 12 * vertices * static_cast<double>(show.frames->count());
}

void check_page_size(const std::string& file, double bytes, double most) {
  if (bytes <= most) return;
  fail(
      "{}: the page would have {:.0f} MB{}, but browsers open at most {} MB; record fewer frames "
      "or coarser meshes, or send the recording itself",
      file, bytes / 1e6, most > viewer::largest_page ? " before compression" : "",
      viewer::largest_page / 1'000'000);
}

int write_page(const viewer::SceneView& show, const ViewOptions& options, std::string_view template_page) {
  // Positions do not compress by a larger factor.
  constexpr double most_compression = 10;
  const auto most = static_cast<double>(viewer::largest_page);
  check_page_size(options.page_file, size_of_frames(show), most_compression * most);
  const std::vector<std::byte> packed = viewer::pack(show);
  const std::string page = viewer::page_with_cargo(template_page, packed, viewer::embedded_module());
  check_page_size(options.page_file, static_cast<double>(page.size()), most);
  viewer::replace_file(options.page_file, page);
  fmt::print("{}: {:.2f} MB, {}{}\n", one_line(options.page_file), static_cast<double>(page.size()) / 1e6,
             counted(show.objects.size(), "object"),
             show.frames ? fmt::format(", {}", counted(show.frames->count(), "frame")) : "");
  return exit_done;
}

void warn_of_others(const ViewOptions& options) {
  if (viewer::is_loopback(options.address)) return;
  fmt::print(stderr,
             "supple: warning: --host {}: everyone who can reach this machine and knows the address below "
             "can see and control the page; the connection is not encrypted\n",
             one_line(options.address));
}

int serve(viewer::SceneView show, const ViewOptions& options, std::string_view page) {
  const std::string watching_page = options.has_spectators ? viewer::page_of_spectators(page) : "";
  viewer::Server server(
      viewer::Session(std::move(show), options.budget),
      {.address = options.address,
       .port = options.port,
       .page = page,
       .watching_page = watching_page,
       .token = options.token_file.empty() ? "" : viewer::token_of_file(options.token_file)});
  warn_of_others(options);
  const Interruption interruption;
  fmt::print("Open {}\n", server.url());
  if (options.has_spectators) fmt::print("Watch {}\n", server.watching_url());
  std::fflush(stdout);
  std::optional<viewer::BrowserVisit> visit;
  if (options.open_browser) {
    visit.emplace(server.url());
    if (!visit->problem().empty()) fmt::print(stderr, "supple: warning: {}\n", one_line(visit->problem()));
  }
  server.run([&] { return interruption.signal() != 0; });
  return exit_done;
}

}  // namespace

int run_view(const ViewOptions& options) {
  check_viewer();
  const std::string page = page_of(options);
  viewer::SceneView show = read_scene_view(options, {"--export", options.page_file});
  print_warnings(show);
  if (!options.page_file.empty()) return write_page(show, options, page);
  warn_of_missing_threads(options.scene.threads);
  return serve(std::move(show), options, page);
}

}  // namespace supple::cli
