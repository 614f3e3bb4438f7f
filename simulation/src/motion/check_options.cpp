#include "motion/check_options.hpp"

#include <cmath>
#include <string>

#include "core/error.hpp"
#include "mesh/number_text.hpp"
#include "motion/spring_network.hpp"

namespace supple {
namespace {

class OptionCheck {
 public:
  explicit OptionCheck(const TriangleMesh& mesh) : mesh_(mesh) {}

  void require(bool allowed, const char* option, double value, const char* range) const {
    if (allowed) return;
    std::string text;
    append_double(text, value);
    fail("masses and springs of mesh '" + mesh_.name + "': " + option + " is " + text + "; it must be " +
         range);
  }
  void at_least_zero(const char* option, double value) const {
    require(value >= 0 && std::isfinite(value), option, value, "finite and not negative");
  }

 private:
  const TriangleMesh& mesh_;
};

}  // namespace

void check_options(const MassSpringOptions& options, const TriangleMesh& mesh) {
  const OptionCheck check(mesh);
  check.require(options.integrator <= Integrator::backward_euler, "integrator",
                static_cast<double>(options.integrator), "verlet, symplectic_euler or backward_euler");
  check.require(options.substeps >= 1, "substeps", options.substeps, "at least 1");
  const double mass = options.vertex_mass;
  check.require(mass > 0 && std::isfinite(mass) && std::isfinite(1 / mass), "vertex_mass", mass,
                "finite and above 0");
  check.at_least_zero("stiffness", options.stiffness);
  check.at_least_zero("damping", options.damping);
  check.at_least_zero("air_friction", options.air_friction);
  check.at_least_zero("bending_stiffness", options.bending_stiffness);
  check.at_least_zero("area_stiffness", options.area_stiffness);
  check.at_least_zero("volume_stiffness", options.volume_stiffness);
  for (int axis = 0; axis < 3; ++axis) {
    check.require(std::isfinite(options.gravity[axis]), "gravity", options.gravity[axis], "finite");
  }
  check.require(options.max_strain > 0, "max_strain", options.max_strain, "above 0; infinite for no limit");
  check.require(options.yield_strain >= 0, "yield_strain", options.yield_strain,
                "not negative; infinite for what is elastic");
  check.require(options.plastic_rate > 0 && std::isfinite(options.plastic_rate), "plastic_rate",
                options.plastic_rate, "finite and above 0");
  for (const std::uint32_t vertex : options.fixed_vertices) {
    check.require(vertex < mesh.positions.size(), "a fixed vertex", vertex,
                  ("below " + std::to_string(mesh.positions.size()) + ", the number of vertices").c_str());
  }
}

}  // namespace supple
