#include "supple/response.hpp"

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "simulation/contact_impulses.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple {
namespace {

/// The motion of one body in the step.
struct Path {
  std::vector<Vec3d> from, to;
  std::vector<double> inverse_masses;
};

void check_body(const Scene& scene, const ResponseBody& body) {
  const std::size_t vertices = scene.vertex_count(body.object);
  const auto check_count = [&](const char* what, std::size_t count) {
    if (count != vertices) {
      fail("respond: " + scene.options(body.object).name + " has " + std::to_string(vertices) +
           " vertices and " + std::to_string(count) + " " + what + "; give one for each vertex");
    }
  };
  check_count("velocities", body.velocities.size());
  if (!body.masses.empty()) check_count("masses", body.masses.size());
  for (std::size_t v = 0; v < body.masses.size(); ++v) {
    if (!(body.masses[v] > 0)) {
      fail("respond: the mass of vertex " + std::to_string(v) + " of " + scene.options(body.object).name +
           " is " + text_of(body.masses[v]) +
           "; it must be above 0, or infinite for a vertex that does not react");
    }
  }
}

void check_bodies(const Scene& scene, std::span<const ResponseBody> bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    check_body(scene, bodies[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (bodies[i].object == bodies[j].object)
        fail("respond: " + scene.options(bodies[i].object).name + " is listed twice; list each object once");
    }
  }
}

Path path_of(const Scene& scene, const ResponseBody& body, double dt) {
  Path path;
  for (std::uint32_t v = 0; v < body.velocities.size(); ++v) {
    path.from.push_back(scene.position(body.object, v));
    path.to.push_back(path.from.back() + dt * body.velocities[v]);
  }
  for (const double mass : body.masses) path.inverse_masses.push_back(1 / mass);
  return path;
}

}  // namespace

double respond(Scene& scene, std::span<const ResponseBody> bodies, double dt,
               const ContactResponse& options) {
  check(options, "respond");
  if (!(dt > 0 && dt < std::numeric_limits<double>::infinity()))
    fail("respond: the step is " + text_of(dt) + " s; it must be above 0");
  check_bodies(scene, bodies);

  std::vector<Path> paths;
  std::vector<RespondingObject> objects;
  paths.reserve(bodies.size());
  for (const ResponseBody& body : bodies) {
    const Path& path = paths.emplace_back(path_of(scene, body, dt));
    objects.push_back({body.object, path.from, path.to, {}, path.inverse_masses});
  }
  const DetectResult& near =
      scene.search({.contacts = ContactKinds::proximity, .proximity_listing = ProximityListing::features});
  ContactImpulses impulses(options, dt);
  const bool is_free =
      impulses.resolve(scene, near.proximity_pairs, objects, {.contacts = ContactKinds::continuous});
  for (const ResponseBody& body : bodies) {
    const auto change = impulses.change(body.object);
    if (!change) continue;
    for (std::size_t v = 0; v < body.velocities.size(); ++v)
      body.velocities[v] += change->of_average_velocity[v];
  }
  return is_free ? 1 : scene.max_step().step;
}

double respond(Scene& scene, ObjectId object, std::span<Vec3d> velocities, std::span<const double> masses,
               double dt, const ContactResponse& options) {
  const ResponseBody body{object, velocities, masses};
  return respond(scene, {&body, 1}, dt, options);
}

}  // namespace supple
