// A sheet rolls up until it touches itself. Its positions are floats inside the user's own vertex type.
#include <cmath>
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

namespace {

struct SimulationVertex {
  float position[3];
  float velocity[3];
};

/// The sheet lies in the xz plane. `turns` is the length of the spiral about the z axis into which it is
/// rolled.
void roll_up(const supple::TriangleMesh& sheet, double turns, std::vector<SimulationVertex>& vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const supple::Vec3d p = sheet.positions[i];
    const double along = p.x + 0.5;
    const double angle = 2 * 3.14159265358979 * turns * along;
    const double radius = 0.3 - 0.1 * along;
    vertices[i].position[0] = static_cast<float>(radius * std::cos(angle));
    vertices[i].position[1] = static_cast<float>(radius * std::sin(angle));
    // The far end leans inward, so that it meets the first turn.
    vertices[i].position[2] = static_cast<float>(p.z);
    vertices[i].position[0] += static_cast<float>(0.4 * along * p.z);
  }
}

}  // namespace

int main() {
  const supple::TriangleMesh sheet = supple::make_cloth(64, 32);
  std::vector<SimulationVertex> vertices(sheet.positions.size());

  supple::Scene scene;
  const supple::ObjectId cloth = scene.add(sheet, {.self_collision = true});
  for (const double turns : {0.5, 0.75, 1.0, 1.25, 1.5}) {
    roll_up(sheet, turns, vertices);
    scene.set_positions(
        cloth, supple::PositionsView(vertices.front().position, vertices.size(), sizeof(SimulationVertex)));
    std::printf("%.2f turns: %zu triangle pairs of the sheet intersect\n", turns,
                scene.detect().contacts.size());
  }
}
