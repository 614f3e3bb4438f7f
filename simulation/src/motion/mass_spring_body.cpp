#include "core/error.hpp"
#include "core/parallel.hpp"
#include "motion/mass_spring.hpp"
#include "motion/worth_threads.hpp"
#include "supple/motion.hpp"

namespace supple {

class MassSpringBody::Implementation {
 public:
  Implementation(const TriangleMesh& rest, const MassSpringOptions& options) : masses(rest, options) {}

  std::optional<std::string> try_step(double seconds) {
    if (!has_threads && is_worth_threads(masses.positions().size(), masses.options().integrator)) {
      parallel = Parallel(masses.options().threads);
      has_threads = true;
    }
    return masses.try_step(seconds, parallel);
  }

  MassSpring masses;
  Parallel parallel{1};
  bool has_threads = false;
};

MassSpringBody::MassSpringBody(const TriangleMesh& rest, const MassSpringOptions& options)
    : implementation_(std::make_unique<Implementation>(rest, options)) {}
MassSpringBody::~MassSpringBody() = default;
MassSpringBody::MassSpringBody(MassSpringBody&&) noexcept = default;
MassSpringBody& MassSpringBody::operator=(MassSpringBody&&) noexcept = default;

void MassSpringBody::step(double seconds) {
  if (const auto failure = try_step(seconds)) fail(*failure);
}
std::optional<std::string> MassSpringBody::try_step(double seconds) {
  return implementation_->try_step(seconds);
}
void MassSpringBody::undo_step() {
  implementation_->masses.undo_step();
}

std::span<const Vec3d> MassSpringBody::positions() const {
  return implementation_->masses.positions();
}
std::span<const Vec3d> MassSpringBody::velocities() const {
  return implementation_->masses.velocities();
}
void MassSpringBody::set_positions(std::span<const Vec3d> positions) {
  implementation_->masses.set_positions(positions);
}
void MassSpringBody::set_velocities(std::span<const Vec3d> velocities) {
  implementation_->masses.set_velocities(velocities);
}
void MassSpringBody::set_external_forces(std::span<const Vec3d> forces) {
  implementation_->masses.set_external_forces(forces);
}
void MassSpringBody::add_drift(Vec3d velocity) {
  implementation_->masses.add_drift(velocity);
}
void MassSpringBody::reflect(int axis) {
  implementation_->masses.reflect(axis);
}

std::size_t MassSpringBody::vertex_count() const {
  return implementation_->masses.positions().size();
}
const MassSpringOptions& MassSpringBody::options() const {
  return implementation_->masses.options();
}
double MassSpringBody::stable_step() const {
  return implementation_->masses.stable_step();
}

MassSpringEnergy MassSpringBody::energy() const {
  return implementation_->masses.energy();
}
Vec3d MassSpringBody::momentum() const {
  return implementation_->masses.momentum();
}
Vec3d MassSpringBody::angular_momentum() const {
  return implementation_->masses.angular_momentum();
}
Vec3d MassSpringBody::center_of_mass() const {
  return implementation_->masses.center_of_mass();
}
Vec3d MassSpringBody::mean_velocity() const {
  return implementation_->masses.mean_velocity();
}
double MassSpringBody::area() const {
  return implementation_->masses.area();
}
double MassSpringBody::volume() const {
  return implementation_->masses.volume();
}
AreaError MassSpringBody::area_error() const {
  return implementation_->masses.area_error();
}
EdgeStrain MassSpringBody::edge_strain() const {
  return implementation_->masses.edge_strain();
}

std::optional<std::array<Vec3d, 2>> MassSpringBody::bounds() const {
  return implementation_->masses.bounds();
}

std::vector<MassSpringBody::Spring> MassSpringBody::springs() const {
  return implementation_->masses.springs();
}

}  // namespace supple
