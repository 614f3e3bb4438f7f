// Readers and writers of mesh files. SUPPLE_FUZZ_FORMAT is obj, off, ply or stl.

#include <algorithm>
#include <bit>
#include <string>

#include "files/mesh_formats.hpp"
#include "supple/error.hpp"
#include "support/check.hpp"

#define SUPPLE_JOIN_(a, b) a##b
#define SUPPLE_JOIN(a, b) SUPPLE_JOIN_(a, b)

namespace {

using supple::fuzz::check;

constexpr auto read_mesh = supple::SUPPLE_JOIN(read_, SUPPLE_FUZZ_FORMAT);
constexpr auto write_mesh = supple::SUPPLE_JOIN(write_, SUPPLE_FUZZ_FORMAT);
constexpr bool keeps_lines = read_mesh == supple::read_obj;
constexpr bool keeps_vertices = read_mesh != supple::read_stl;

bool equal(double a, double b) {
  return (a != a && b != b) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void check_equal(const supple::TriangleMesh& a, const supple::TriangleMesh& b) {
  check(a.triangles.size() == b.triangles.size(), "a written mesh has other triangles");
  if (!keeps_vertices) return;
  check(a.triangles == b.triangles, "a written mesh has other triangles");
  check(a.edges == b.edges && a.points == b.points, "a written mesh has other lines or points");
  check(std::equal(a.positions.begin(), a.positions.end(), b.positions.begin(), b.positions.end(),
                   [](const supple::Vec3d& p, const supple::Vec3d& q) {
                     return equal(p.x, q.x) && equal(p.y, q.y) && equal(p.z, q.z);
                   }),
        "a written mesh has other positions");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  supple::TriangleMesh mesh;
  try {
    mesh = read_mesh({reinterpret_cast<const char*>(data), size}, "input");
  } catch (const supple::Error& error) {
    supple::fuzz::check_message(error.what(), "input");
    return 0;
  }
  supple::check_mesh(mesh);  // a mesh that was read is valid
  const std::size_t most = 64 + 8 * size;
  check(mesh.positions.capacity() <= most && mesh.triangles.capacity() <= most &&
            mesh.edges.capacity() <= most && mesh.points.capacity() <= most,
        "a count of the file decides how much memory is used");
  if (keeps_lines || (mesh.edges.empty() && mesh.points.empty()))
    check_equal(mesh, read_mesh(write_mesh(mesh), "written"));
  return 0;
}
