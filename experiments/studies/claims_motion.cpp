#include <fmt/core.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "fit.hpp"
#include "judgement.hpp"
#include "studies/claims.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/motion.hpp"
#include "supple/scene.hpp"
#include "supple/simulation_descriptions.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// A deformation of the rest shape that depends on time, written to `positions`; also calls
/// `visit(position)`.
template <class Visit>
void deform(const std::vector<Vec3d>& rest, double time, std::vector<Vec3d>& positions, const Visit& visit) {
  for (std::size_t i = 0; i < rest.size(); ++i) {
    positions[i] = rest[i] * (1 + 0.05 * time) + Vec3d{time, 0, 0};
    visit(positions[i]);
  }
}

struct Bounds {
  Vec3d low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  void extend(const Vec3d& p) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::fmin(low[axis], p[axis]);
      high[axis] = std::fmax(high[axis], p[axis]);
    }
  }
};

/// Seconds of one pass that moves the vertices and bounds them, and of two passes, by round.
std::array<std::vector<double>, 2> one_pass_and_two(const std::vector<Vec3d>& rest, int rounds) {
  std::vector<Vec3d> positions(rest.size());
  std::array<std::vector<double>, 2> seconds;
  for (int round = 0; round < rounds; ++round) {
    Bounds bounds, later;
    seconds[0].push_back(
        seconds_of([&] { deform(rest, round, positions, [&](const Vec3d& p) { bounds.extend(p); }); }));
    seconds[1].push_back(seconds_of([&] {
      deform(rest, round, positions, [](const Vec3d&) {});
      for (const Vec3d& p : positions) later.extend(p);
    }));
    if (bounds.low != later.low || bounds.high != later.high)
      throw Error("two boxes of the same points differ");
  }
  return seconds;
}

/// A body that vibrates: every vertex gets a velocity.
MassSpringBody vibrating(const TriangleMesh& mesh, Integrator integrator) {
  MassSpringOptions options;
  options.integrator = integrator;
  options.damping = 0;
  options.threads = 1;
  MassSpringBody body(mesh, options);
  std::vector<Vec3d> velocities;
  for (const Vec3d& p : mesh.positions) velocities.push_back({0.2 * p.y, -0.3 * p.x, 0.1 * p.z});
  body.set_velocities(velocities);
  return body;
}

/// The energy at the end divided by that at the start; nothing when the motion fails or the energy grows
/// tenfold.
std::optional<double> energy_kept(MassSpringBody body, double step, double seconds) {
  const double start = body.energy().total();
  const auto steps = static_cast<std::uint64_t>(std::ceil(seconds / step));
  for (std::uint64_t i = 0; i < steps; ++i) {
    if (body.try_step(step)) return std::nullopt;
    if (!(body.energy().total() < 10 * start)) return std::nullopt;
  }
  return body.energy().total() / start;
}

}  // namespace

/// Section 5.2: the translation is added to the box.
Finding translation_of_volumes(const ClaimsOptions& options) {
  const TriangleMesh mesh = make_icosphere(options.largest_frequency);
  Scene scene({.contacts = ContactKinds::none, .threads = 1});
  const ObjectId id = scene.add(mesh);
  scene.detect();
  std::vector<double> translations, refits;
  std::uint64_t translated = 0, refitted = 0;
  std::vector<Vec3d> positions = mesh.positions;
  for (int round = 1; round <= options.rounds; ++round) {
    scene.translate(id, {0.01, 0, 0});
    const StepStats& moved = scene.detect().stats;
    translations.push_back(moved.refit_seconds);
    translated = moved.triangles_refitted;
    deform(mesh.positions, 0.01 * round, positions, [](const Vec3d&) {});
    scene.set_positions(id, positions);
    const StepStats& deformed = scene.detect().stats;
    refits.push_back(deformed.refit_seconds);
    refitted = deformed.triangles_refitted;
  }
  Finding finding{{"translation", "5.2", "Adding the translation to the volume “is a quick process”."},
                  {"claims_translation",
                   "Updating the volumes of one object after motion",
                   {{"update", "Update"}, {"us", "µs"}, {"triangles", "Triangles read"}}}};
  finding.table.add({"translation of the octree", least(translations) * 1e6, translated});
  finding.table.add({"refit of the octree", least(refits) * 1e6, refitted});
  const Estimate ratio = ratio_of(translations, refits);
  finding.claim.verdict = both(verdict_of(translated == 0), below(ratio, 0.1));
  finding.claim.number = ratio;
  finding.claim.quantity = "time of a translation / of a refit";
  finding.claim.reason = fmt::format(
      "For a sphere of {} triangles, a translation takes {} µs and reads no triangle; a refit of the octree "
      "takes {} µs. Quick means here: less than a tenth of a refit.",
      cli::grouped(mesh.triangles.size()), rounded(least(translations) * 1e6), rounded(least(refits) * 1e6));
  return finding;
}

/// Section 5.2: the box is updated within the loop of the simulation instead of a loop of its own.
Finding one_loop(const ClaimsOptions& options) {
  const TriangleMesh mesh = make_icosphere(options.largest_frequency);
  const auto [one, two] = one_pass_and_two(mesh.positions, options.rounds);
  Finding finding{
      {"one-loop", "5.2",
       "“We take advantage of the physical simulation process to add these routines rather than use "
       "more loops”. Read as: one loop takes less time than two."},
      {"claims_loops",
       "Moving the vertices of one object and bounding them",
       {{"loops", "Loops"}, {"us", "µs"}}}};
  finding.table.add({std::uint64_t{1}, least(one) * 1e6});
  finding.table.add({std::uint64_t{2}, least(two) * 1e6});
  const Estimate ratio = ratio_of(two, one);
  finding.claim.verdict = above(ratio, 1);
  finding.claim.number = ratio;
  finding.claim.quantity = "time of two loops / of one";
  finding.claim.reason = fmt::format(
      "Moving the vertices of a sphere of {} triangles and bounding them takes {} times as long in two loops "
      "as "
      "in one. Supple refits in a loop of its own by default, because positions come from the user's "
      "program; "
      "fused_refit uses the loop of the motion.",
      cli::grouped(mesh.triangles.size()), text_of(ratio));
  return finding;
}

Finding primitives_and_motion(const ClaimsOptions& options) {
  Finding finding{{"slower-motion", "7", "“With more primitives, the physical motion reduces its speed”."},
                  {"claims_motion",
                   "Motion of one body",
                   {{"model", "Model"},
                    {"vertices", "Vertices"},
                    {"step_us", "µs per step"},
                    {"ns_per_vertex", "ns per vertex and step"}}}};
  Points times;
  for (const char* const model : {"pawn", "fish", "rabbit", "human", "bike"}) {
    const TriangleMesh mesh = make_model(model);
    MassSpringBody body = vibrating(mesh, Integrator::verlet);
    const double step = body.stable_step() / 2;
    std::vector<double> steps;
    for (int i = 0; i < 20 * options.rounds; ++i) steps.push_back(seconds_of([&] { body.step(step); }));
    const auto vertices = static_cast<double>(body.vertex_count());
    times.emplace_back(vertices, least(steps));
    finding.table.add(
        {model, std::uint64_t{body.vertex_count()}, least(steps) * 1e6, least(steps) / vertices * 1e9});
  }
  const PowerLaw fit = fit_power_law(times);
  const Estimate exponent{fit.exponent, fit.standard_error};
  finding.claim.verdict = above(exponent, 0.5);
  finding.claim.number = exponent;
  finding.claim.quantity = "exponent of the time of a step, by vertices";
  finding.claim.reason =
      fmt::format("The time of a step grows as the number of vertices to the power of {}.", text_of(fit));
  return finding;
}

Finding stability_of_integrators(const ClaimsOptions& options) {
  Finding finding{
      {"verlet", "4",
       "“We observed more stable and realistic deformations with the Verlet scheme” than with Euler "
       "Backward integration."},
      {"claims_integrators",
       "Energy after the motion of a rabbit without damping, divided by that at the start",
       {{"integrator", "Integrator"},
        {"step_ms", "Step ms"},
        {"of_stable_step", "of the stable step"},
        {"energy", "Energy kept"}}}};
  constexpr std::array parts{0.5, 1.0, 2.0, 4.0, 8.0, 16.0};  // of the stable step
  const TriangleMesh mesh = make_model("rabbit");
  const double stable = vibrating(mesh, Integrator::verlet).stable_step();
  std::array<double, 3> largest{}, energies{};
  const auto verlet = static_cast<std::size_t>(Integrator::verlet),
             backward = static_cast<std::size_t>(Integrator::backward_euler);
  for (std::size_t k = 0; k < words<Integrator>.size(); ++k) {
    const auto integrator = static_cast<Integrator>(k);
    for (const double part : parts) {
      const auto kept = energy_kept(vibrating(mesh, integrator), part * stable, options.motion_seconds);
      finding.table.add(
          {words<Integrator>[k], part * stable * 1e3, part, kept ? Cell(*kept) : Cell("unstable")});
      if (kept) largest[k] = part;
      if (part == parts.front() && kept) energies[k] = *kept;
    }
  }
  const bool is_more_stable = largest[verlet] > largest[backward];
  const bool keeps_more = std::abs(energies[verlet] - 1) < std::abs(energies[backward] - 1);
  finding.claim.verdict = verdict_of(is_more_stable && keeps_more);
  finding.claim.number = Estimate{largest[verlet] / largest[backward], NAN};
  finding.claim.quantity = "longest step with Verlet / with backward Euler";
  finding.claim.reason = fmt::format(
      "{}{}. The longest step at which the motion stays bounded is {} times the stable step with Verlet and "
      "{} "
      "times with backward Euler (of {} tried). At half the stable step, a body without damping has after {} "
      "s {:.3f} "
      "of its energy with Verlet and {:.3f} with backward Euler.",
      is_more_stable ? "Verlet is more stable" : "Verlet is not more stable",
      keeps_more ? "; it keeps the energy better" : "; it does not keep the energy better", largest[verlet],
      largest[backward], parts.size(), options.motion_seconds, energies[verlet], energies[backward]);
  return finding;
}

}  // namespace supple::experiments
