// Scene files. Meshes and frames are named in a folder that has none.

#include <string>

#include "scene_file/scene_file.hpp"
#include "supple/error.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace supple;
  constexpr std::uint64_t most_triangles = 20'000;
  const std::filesystem::path path = "/nowhere/input.toml";
  try {
    fuzz::ByteReader bytes(data, size);
    const cli::Input input =
        cli::read_scene_text(std::string(bytes.text()), path, {.most_triangles = most_triangles});
    std::uint64_t triangles = 0;
    for (const cli::InputObject& object : input.objects) {
      check_mesh(object.mesh);
      triangles += object.mesh.triangles.size();
    }
    fuzz::check(triangles <= most_triangles && !input.objects.empty(),
                "the scene has another size than allowed");
  } catch (const Error& error) {
    fuzz::check_message(error.what(), "/nowhere");
  }
  return 0;
}
