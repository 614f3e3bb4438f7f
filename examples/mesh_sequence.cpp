// A recorded motion, one mesh file per frame, plays among other objects:
//   example_mesh_sequence frame_0.ply frame_1.ply ...
// Without arguments the program first writes some files itself.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "supple/mesh_file.hpp"
#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/supple.hpp"

namespace {

constexpr double seconds_per_frame = 0.1;

/// A torus that is squeezed and returns to its shape.
std::vector<std::filesystem::path> written_frames() {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "supple_mesh_sequence";
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> files;
  for (int frame = 0; frame <= 8; ++frame) {
    supple::TriangleMesh mesh = supple::make_torus(32, 16);
    const double width = 0.7 + 0.3 * supple::cos_turns(frame / 8.0);
    for (supple::Vec3d& p : mesh.positions) p.x *= width;
    files.push_back(folder / ("frame_" + std::to_string(frame) + ".ply"));
    supple::save_mesh(mesh, files.back());
  }
  return files;
}

/// Frames with linear interpolation between them; the last frame stays.
class Playback {
 public:
  explicit Playback(const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) {
      frames_.push_back(supple::load_mesh(file));
      if (frames_.back().positions.size() != frames_.front().positions.size())
        throw supple::Error(file.string() + ": another number of vertices than the first frame");
    }
  }

  const supple::TriangleMesh& first() const { return frames_.front(); }

  void operator()(double seconds, std::span<supple::Vec3d> positions) const {
    const double place = std::min(seconds / seconds_per_frame, static_cast<double>(frames_.size() - 1));
    const auto frame = static_cast<std::size_t>(place);
    const std::size_t next = std::min(frame + 1, frames_.size() - 1);
    const double part = place - static_cast<double>(frame);
    for (std::size_t i = 0; i < positions.size(); ++i)
      positions[i] = (1 - part) * frames_[frame].positions[i] + part * frames_[next].positions[i];
  }

 private:
  std::vector<supple::TriangleMesh> frames_;
};

}  // namespace

int main(int argument_count, char** arguments) {
  std::vector<std::filesystem::path> files(arguments + 1, arguments + argument_count);
  if (files.empty()) files = written_frames();
  try {
    const Playback playback(files);
    supple::SimulationOptions options;
    options.time_step = seconds_per_frame / 2;
    supple::Simulation simulation(options);
    simulation.add(playback.first(), {.name = "recorded"}, playback);
    supple::TriangleMesh rod = supple::make_box({0.1, 1, 0.1}, 4);
    for (supple::Vec3d& p : rod.positions) p.x += 0.28;
    simulation.add(rod, {.name = "rod"});
    const double end = seconds_per_frame * static_cast<double>(files.size() - 1);
    while (simulation.time() < end) {
      const supple::DetectResult& result = simulation.step();
      std::printf("%.2f s: %zu contacts\n", simulation.time(), result.contacts.size());
    }
  } catch (const supple::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
