// The library's own readers of meshes with solids, of 3MF, AMF and COLLADA. The first byte chooses the
// reader. A file of TetGen is followed by the next after a zero byte: nodes, elements, faces.

#include <string>
#include <string_view>

#include "assimp/collada_text.hpp"
#include "readers.hpp"
#include "supple/error.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"

namespace {

supple::TriangleMesh read(std::size_t choice, std::string_view bytes) {
  using namespace supple;
  switch (choice) {
    case 0:
      return read_gmsh(bytes, "input");
    case 1:
      return read_vtk(bytes, "input");
    case 2:
      return read_medit(bytes, "input");
    case 3:
      return read_medit_binary(bytes, "input");
    case 4:
      return read_3mf(bytes, "input").mesh;
    case 6:
      return read_vtk_xml(bytes, "input");
    case 7:
      return read_mfem(bytes, "input");
    case 8:
      return read_amf(bytes, "input").mesh;
    case 9:
      collada_text(bytes, "input");
      return {};
    default: {
      const auto next_file = [&] {
        const std::string_view file = bytes.substr(0, bytes.find('\0'));
        bytes.remove_prefix(file.size() + (file.size() < bytes.size()));
        return TetgenFile{file, "input"};
      };
      const TetgenFile nodes = next_file(), elements = next_file();
      return read_tetgen(nodes, elements, next_file());
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  supple::fuzz::ByteReader bytes(data, size);
  // The first six keep their meaning for the inputs of the corpus.
  const std::size_t byte = bytes.byte(), choice = byte < 248 ? byte % 6 : 6 + byte % 4;
  supple::TriangleMesh mesh;
  try {
    mesh = read(choice, bytes.text());
  } catch (const supple::Error& error) {
    supple::fuzz::check_message(error.what(), "input");
    return 0;
  }
  supple::check_mesh(mesh);
  // The components of 3MF and AMF may repeat a mesh, and the arrays of VTK may be compressed.
  if (choice != 4 && choice != 6 && choice != 8) {
    const std::size_t most = 64 + 8 * size;
    supple::fuzz::check(mesh.positions.capacity() <= most && mesh.triangles.capacity() <= most,
                        "a count of the file decides how much memory is used");
  }
  return 0;
}
