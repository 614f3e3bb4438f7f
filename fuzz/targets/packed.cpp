// Packed scenes, which exported pages contain. The target adds the header with the right checksum, because a
// fuzzer does not find one.

#include <algorithm>
#include <cstddef>
#include <span>

#include "packed/packed_scene.hpp"
#include "session.hpp"
#include "supple/error.hpp"
#include "support/check.hpp"
#include "support/session_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace supple;
  const std::span<const std::byte> content(reinterpret_cast<const std::byte*>(data), size);
  try {
    const std::vector<std::byte> bytes = viewer::with_header(content);
    viewer::SceneView show = viewer::unpack(bytes);
    fuzz::check(show.frames || viewer::pack(show) == bytes, "a scene is packed otherwise than it was");
    show.simulation.scene.threads = 1;
    viewer::Session session(std::move(show));
    viewer::MessageWriter writer;
    session.greet();
    session.command(R"({"do": "credit", "frames": 2})");
    fuzz::drain(session, writer);
    session.advance(0.02);
    fuzz::drain(session, writer);
  } catch (const Error& error) {
    fuzz::check_message(error.what(), "");
  }
  return 0;
}
