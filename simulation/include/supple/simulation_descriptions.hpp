#pragma once

#include "supple/description.hpp"
#include "supple/motion.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/simulation.hpp"
#include "supple/wave_motion.hpp"

// Descriptions of the options of simulations (description.hpp).

namespace supple {

template <>
inline constexpr std::array words<Integrator>{"verlet", "symplectic_euler", "backward_euler"};

template <>
struct Description<MassSpringOptions> {
  static constexpr const char* name = "MassSpringOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = MassSpringOptions;
    const auto number = [&](const char* field, double Options::*member, const char* unit, ValueRange range,
                            const char* doc) {
      visitor(
          Field<Options, double>{.name = field, .member = member, .doc = doc, .range = range, .unit = unit});
    };
    visitor(Field<Options, Integrator>{
        .name = "integrator",
        .member = &Options::integrator,
        .doc = "How a step is integrated: verlet (second order) and symplectic_euler (first order) are fast "
               "and need short steps; backward_euler is slower and stable at any stiffness"});
    visitor(Field<Options, std::uint32_t>{.name = "substeps",
                                          .member = &Options::substeps,
                                          .doc = "Number of equal parts of a step",
                                          .range = ValueRange::from(1, 1'000'000)});
    visitor(Field<Options, double>{.name = "vertex_mass",
                                   .member = &Options::vertex_mass,
                                   .doc = "Mass of each vertex",
                                   .range = ValueRange::above(0),
                                   .unit = "kg",
                                   .key = "mass"});
    number("stiffness", &Options::stiffness, "N/m", ValueRange::from(0),
           "Stiffness of the spring on each edge");
    number(
        "rest_length", &Options::rest_length, "", ValueRange::above(0),
        "Length of each spring at rest (the paper's spring length), as a factor of its length in the mesh");
    visitor(Field<Options, bool>{.name = "connect_pieces",
                                 .member = &Options::connect_pieces,
                                 .doc = "Springs also connect the pieces of the mesh, so that they do not "
                                        "drift apart"});
    number("damping", &Options::damping, "N s/m", ValueRange::from(0), "Damping along each spring");
    number("air_friction", &Options::air_friction, "N s/m", ValueRange::from(0),
           "Friction of each vertex against the air");
    number("bending_stiffness", &Options::bending_stiffness, "N/m", ValueRange::from(0),
           "Stiffness of a spring across each edge, between the two opposite corners");
    number("area_stiffness", &Options::area_stiffness, "N/m", ValueRange::from(0),
           "Stiffness of a force that preserves the area of each triangle");
    number("volume_stiffness", &Options::volume_stiffness, "Pa", ValueRange::from(0),
           "Bulk modulus of the interior: a pressure preserves the volume of each closed part of the mesh; "
           "it is an error when no part is closed");
    visitor(Field<Options, Vec3d>{.name = "gravity",
                                  .member = &Options::gravity,
                                  .doc = "Acceleration of each vertex",
                                  .unit = "m/s²"});
    number("max_strain", &Options::max_strain, "", ValueRange::above(0).or_infinity(),
           "Limit of the strain: an edge changes by at most this fraction of its rest length");
    number("yield_strain", &Options::yield_strain, "", ValueRange::from(0).or_infinity(),
           "Strain beyond which edges flow: they keep a part of the deformation");
    number("plastic_rate", &Options::plastic_rate, "1/s", ValueRange::above(0),
           "Rate of the flow: the strain beyond yield_strain decays as e^(-plastic_rate t)");
    visitor(Field<Options, std::vector<std::uint32_t>>{.name = "fixed_vertices",
                                                       .member = &Options::fixed_vertices,
                                                       .doc = "Vertices that forces do not move",
                                                       .key = "fixed"});
    visitor(Field<Options, std::uint32_t>{.name = "threads",
                                          .member = &Options::threads,
                                          .doc = "Worker threads; 0 means one per core",
                                          .range = ValueRange::from(0, 1024),
                                          .is_of_machine = true});
  }
};

template <>
struct Description<MassSpringMotion::Handle> {
  static constexpr const char* name = "MassSpringMotion::Handle";
  static constexpr void visit(auto&& visitor) {
    using Handle = MassSpringMotion::Handle;
    visitor(Field<Handle, std::vector<std::uint32_t>>{
        .name = "vertices", .member = &Handle::vertices, .doc = "Vertices that are moved"});
    visitor(Field<Handle, Vec3d>{
        .name = "by", .member = &Handle::by, .doc = "Displacement of the vertices", .unit = "m"});
    visitor(Field<Handle, double>{.name = "seconds",
                                  .member = &Handle::seconds,
                                  .doc = "Duration of the movement; afterwards the vertices stay",
                                  .range = ValueRange::above(0),
                                  .unit = "s"});
  }
};

template <>
struct Description<MassSpringMotion> {
  static constexpr const char* name = "MassSpringMotion";
  static constexpr void visit(auto&& visitor) {
    using Motion = MassSpringMotion;
    visitor(Field<Motion, MassSpringOptions>{
        .name = "springs", .member = &Motion::springs, .doc = "Masses and springs of the object"});
    visitor(Field<Motion, Vec3d>{.name = "velocity",
                                 .member = &Motion::velocity,
                                 .doc = "Velocity that the object gets after deform_seconds",
                                 .unit = "m/s"});
    visitor(Field<Motion, double>{.name = "random_speed",
                                  .member = &Motion::random_speed,
                                  .doc = "Speed in a random direction that is added to the velocity",
                                  .range = ValueRange::from(0),
                                  .unit = "m/s"});
    visitor(Field<Motion, double>{.name = "random_force",
                                  .member = &Motion::random_force,
                                  .doc = "Root mean square of random forces that deform the object",
                                  .range = ValueRange::from(0),
                                  .unit = "N"});
    visitor(Field<Motion, double>{.name = "deform_seconds",
                                  .member = &Motion::deform_seconds,
                                  .doc = "How long the object deforms in place; then constant random forces "
                                         "end, and the object gets its velocity",
                                  .range = ValueRange::from(0),
                                  .unit = "s"});
    visitor(Field<Motion, double>{.name = "force_change_seconds",
                                  .member = &Motion::force_change_seconds,
                                  .doc = "Time in which the random forces change into others; they act until "
                                         "the end. 0: constant forces",
                                  .range = ValueRange::from(0),
                                  .unit = "s"});
    visitor(Field<Motion, std::optional<std::uint64_t>>{
        .name = "seed",
        .member = &Motion::seed,
        .doc = "Seed of the random numbers, instead of the number of the object; each copy adds its own "
               "number"});
    visitor(Field<Motion, std::vector<MassSpringMotion::Handle>>{
        .name = "handles",
        .member = &Motion::handles,
        .doc = "Vertices that are moved by a vector and then held",
        .key = "pull"});
  }
};

template <>
struct Description<RigidMotion> {
  static constexpr const char* name = "RigidMotion";
  static constexpr void visit(auto&& visitor) {
    using Motion = RigidMotion;
    visitor(Field<Motion, Vec3d>{
        .name = "velocity", .member = &Motion::velocity, .doc = "Velocity at the start", .unit = "m/s"});
    visitor(Field<Motion, double>{.name = "random_speed",
                                  .member = &Motion::random_speed,
                                  .doc = "Speed in a random direction that is added to the velocity",
                                  .range = ValueRange::from(0),
                                  .unit = "m/s"});
    visitor(Field<Motion, Vec3d>{.name = "spin",
                                 .member = &Motion::spin,
                                 .doc =
                                     "Angular velocity: its direction is the axis through the centre of the "
                                     "vertices, its length the speed, counter-clockwise",
                                 .unit = "degrees/s"});
    visitor(Field<Motion, double>{.name = "random_spin",
                                  .member = &Motion::random_spin,
                                  .doc = "Angular velocity about a random axis that is added to the spin",
                                  .range = ValueRange::from(0),
                                  .unit = "degrees/s"});
    visitor(Field<Motion, std::optional<std::uint64_t>>{
        .name = "seed",
        .member = &Motion::seed,
        .doc = "Seed of the random numbers, instead of the number of the object; each copy adds its own "
               "number"});
  }
};

template <>
struct Description<WaveMotion> {
  static constexpr const char* name = "WaveMotion";
  static constexpr void visit(auto&& visitor) {
    using Motion = WaveMotion;
    visitor(Field<Motion, Vec3d>{
        .name = "velocity", .member = &Motion::velocity, .doc = "Velocity of the drift", .unit = "units/s"});
    visitor(Field<Motion, double>{
        .name = "amplitude", .member = &Motion::amplitude, .doc = "Amplitude of the waves", .unit = "units"});
    visitor(Field<Motion, double>{.name = "wavelength",
                                  .member = &Motion::wavelength,
                                  .doc = "Length of the waves",
                                  .range = ValueRange::above(0),
                                  .unit = "units"});
    visitor(Field<Motion, double>{.name = "period",
                                  .member = &Motion::period,
                                  .doc = "Period of the waves",
                                  .range = ValueRange::above(0),
                                  .unit = "s"});
    visitor(Field<Motion, std::uint64_t>{
        .name = "seed",
        .member = &Motion::seed,
        .doc = "Seed of the phases of the waves; each copy adds its own number"});
  }
};

template <>
struct Description<ContactResponse> {
  static constexpr const char* name = "ContactResponse";
  static constexpr void visit(auto&& visitor) {
    using Options = ContactResponse;
    visitor(Field<Options, double>{.name = "thickness",
                                   .member = &Options::thickness,
                                   .doc = "Distance that the response keeps between elements",
                                   .range = ValueRange::above(0),
                                   .unit = "m"});
    visitor(Field<Options, double>{
        .name = "restitution",
        .member = &Options::restitution,
        .doc = "Fraction of the approaching velocity that is reversed: 0 stops the approach, 1 reverses it",
        .range = ValueRange::from(0, 1)});
    visitor(Field<Options, double>{.name = "friction",
                                   .member = &Options::friction,
                                   .doc = "Coulomb's coefficient of friction",
                                   .range = ValueRange::from(0)});
    visitor(
        Field<Options, std::uint32_t>{.name = "iterations",
                                      .member = &Options::iterations,
                                      .doc = "Largest number of rounds of detection and impulses per step",
                                      .range = ValueRange::from(1, 1000)});
  }
};

template <>
struct Description<SimulationOptions> {
  static constexpr const char* name = "SimulationOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = SimulationOptions;
    visitor(Field<Options, SceneOptions>{
        .name = "scene", .member = &Options::scene, .doc = "Options of the detection"});
    visitor(Field<Options, double>{.name = "time_step",
                                   .member = &Options::time_step,
                                   .doc = "Time from one frame to the next",
                                   .range = ValueRange::above(0),
                                   .unit = "s"});
    visitor(Field<Options, std::optional<Border>>{
        .name = "border",
        .member = &Options::border,
        .doc = "Lowest and highest corner of the box that reflects objects",
        .key = "bounds"});
    visitor(
        Field<Options, std::uint64_t>{.name = "seed",
                                      .member = &Options::seed,
                                      .doc = "Seed of the random numbers: velocities, forces and rotations"});
    visitor(Field<Options, bool>{
        .name = "fused_refit",
        .member = &Options::fused_refit,
        .doc =
            "The loop of the motion finds the bounds of each body, instead of a loop of the refit; needs a "
            "lazy refit",
        .truth_words = {"off", "on"}});
    visitor(Field<Options, std::optional<ContactResponse>>{
        .name = "response", .member = &Options::response, .doc = "Response to contacts"});
  }
};

}  // namespace supple
