// FBX files, and poses of their clips.

#include <vector>

#include "supple/animation.hpp"
#include "supple/error.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"
#include "support/temporary_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace supple;
  fuzz::ByteReader bytes(data, size);
  const fuzz::TemporaryFile file{".fbx"};
  file.write(bytes.text());
  try {
    const AnimatedMesh mesh(file.path());
    check_mesh(mesh.mesh());
    std::vector<Vec3d> positions(mesh.mesh().positions.size());
    for (std::size_t clip = 0; clip < mesh.clips().size(); ++clip) {
      const AnimationClip& range = mesh.clips()[clip];
      fuzz::check(range.start <= range.end, "a clip ends before it starts");
      for (const double time : {range.start, range.start / 2 + range.end / 2, range.end + 1})
        mesh.positions(clip, time, positions);
    }
  } catch (const Error& error) {
    fuzz::check_message(error.what(), "");
  }
  return 0;
}
