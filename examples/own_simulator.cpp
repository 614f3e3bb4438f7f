// Positions from your own simulator, here a drum skin with waves. A mass-spring body of the library falls
// through it.
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/supple.hpp"

namespace {

/// A drum skin: the wave equation for the heights of a grid that is fixed at its rim.
class DrumSkin {
 public:
  static constexpr std::uint32_t squares = 24;

  DrumSkin() : mesh_(supple::make_cloth(squares, squares)), speeds_(mesh_.positions.size()) {
    mesh_.name = "skin";
    mesh_.positions[vertex(8, 8)].y = 0.3;  // pluck it
  }

  void advance(double seconds) {
    constexpr double stiffness = 400;
    std::vector<supple::Vec3d>& p = mesh_.positions;
    for (std::uint32_t row = 1; row < squares; ++row) {
      for (std::uint32_t column = 1; column < squares; ++column) {
        const double neighbours = p[vertex(column - 1, row)].y + p[vertex(column + 1, row)].y +
                                  p[vertex(column, row - 1)].y + p[vertex(column, row + 1)].y;
        speeds_[vertex(column, row)] += seconds * stiffness * (neighbours - 4 * p[vertex(column, row)].y);
      }
    }
    for (std::size_t i = 0; i < p.size(); ++i) p[i].y += seconds * speeds_[i];
  }

  const supple::TriangleMesh& mesh() const { return mesh_; }

 private:
  static std::size_t vertex(std::uint32_t column, std::uint32_t row) {
    return std::size_t{row} * (squares + 1) + column;
  }

  supple::TriangleMesh mesh_;
  std::vector<double> speeds_;
};

}  // namespace

int main() {
  DrumSkin drum;
  supple::Simulation simulation;
  const supple::ObjectId skin = simulation.add(drum.mesh());

  supple::TriangleMesh ball = supple::make_icosphere(4);
  ball.name = "ball";
  for (supple::Vec3d& p : ball.positions) p = 0.2 * p + supple::Vec3d{0, 0.5, 0};
  supple::MassSpringMotion falling;
  falling.springs.gravity = {0, -9.81, 0};
  simulation.add(ball, {}, falling);

  for (int frame = 0; frame < 50; ++frame) {
    drum.advance(simulation.options().time_step);
    simulation.set_positions(skin, drum.mesh().positions);
    const supple::DetectResult& result = simulation.step();
    if (frame % 5 == 4)
      std::printf("%.2f s: %zu triangle pairs of ball and skin intersect\n", simulation.time(),
                  result.contacts.size());
  }
}
