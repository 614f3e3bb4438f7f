#pragma once

#include <string>
#include <string_view>

#include "supple/mesh.hpp"

namespace supple {

// Readers take the bytes of a whole file and its name for messages; they leave the name of the mesh empty.
// Writers return the bytes of a whole file for a mesh that passed check_mesh.

TriangleMesh read_obj(std::string_view bytes, const std::string& file);
TriangleMesh read_off(std::string_view bytes, const std::string& file);
TriangleMesh read_ply(std::string_view bytes, const std::string& file);
TriangleMesh read_stl(std::string_view bytes, const std::string& file);

std::string write_obj(const TriangleMesh& mesh);
std::string write_off(const TriangleMesh& mesh);
std::string write_ply(const TriangleMesh& mesh);
std::string write_stl(const TriangleMesh& mesh);

}  // namespace supple
