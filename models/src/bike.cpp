#include <array>
#include <utility>
#include <vector>

#include "built_in.hpp"
#include "mesh_builder.hpp"
#include "supple/trigonometry.hpp"

// A racing bicycle, modelled in metres and scaled at the end. x points forward, y up; the chain is on the
// right, at +z.
//
// 2 · 9543 vertices − 18238 faces = 848 = 4 · 212. So the surface needs exactly 212 closed parts of genus 0,
// and any number of rings: 64 spokes, 112 chain links, and the 36 parts that `make_bike` lists.

namespace supple::models {
namespace {

constexpr Vec3d rear_hub{0, 0.340, 0};
constexpr Vec3d front_hub{1.005, 0.340, 0};
constexpr Vec3d bottom_bracket{0.420, 0.275, 0};
constexpr Vec3d seat_cluster{0.278, 0.745, 0};
constexpr Vec3d head_low{0.862, 0.705, 0};
constexpr Vec3d head_high{0.818, 0.845, 0};
constexpr Vec3d sideways{0, 0, 1};

constexpr double wheel_radius = 0.340;
constexpr double rim_radius = 0.312;
constexpr double chain_z = 0.045;
constexpr double chainring_radius = 0.095;
constexpr double sprocket_radius = 0.040;

Vec3d direction_at(double turns) {
  return {cos_turns(turns), sin_turns(turns), 0};
}

Vec3d at_side(Vec3d point, double z) {
  return {point.x, point.y, z};
}

void add_curved_tube(MeshBuilder& builder, std::span<const Vec3d> control_points, double start_radius,
                     double end_radius, std::uint32_t rings, std::uint32_t sides) {
  const std::vector<Vec3d> path = resample(smooth_curve(control_points, 16), rings);
  std::vector<double> radii;
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    radii.push_back(start_radius + (end_radius - start_radius) * ring / (rings - 1));
  builder.add_tube(path, radii, sides);
}

void add_spokes(MeshBuilder& builder, Vec3d hub) {
  constexpr int count = 32;
  for (int spoke = 0; spoke < count; ++spoke) {
    const double turns = (spoke + 0.5) / count;
    const double side = spoke % 2 == 0 ? 1 : -1;
    // Spokes leave the flange in pairs, one forward and one backward, so that they cross as on a real wheel.
    const double lean = (spoke / 2) % 2 == 0 ? 0.17 : -0.17;
    const Vec3d start = hub + direction_at(turns + lean) * 0.024 + sideways * (0.030 * side);
    const Vec3d end = hub + direction_at(turns) * (rim_radius - 0.006) + sideways * (0.003 * side);
    builder.add_bar(start, end, 0.0024, 0.0020, 10, 3);
  }
}

void add_wheel(MeshBuilder& builder, Vec3d hub) {
  builder.add_ring(hub, sideways, wheel_radius - 0.017, 0.016, 0.017, 72, 10);  // tyre
  builder.add_ring(hub, sideways, rim_radius - 0.006, 0.011, 0.010, 72, 6);
  add_spokes(builder, hub);

  constexpr std::array<LathePoint, 10> profile{{{0.007, -0.062},
                                                {0.008, -0.040},
                                                {0.028, -0.033},
                                                {0.028, -0.027},
                                                {0.014, -0.020},
                                                {0.014, 0.020},
                                                {0.028, 0.027},
                                                {0.028, 0.033},
                                                {0.008, 0.040},
                                                {0.007, 0.062}}};
  builder.add_lathe(hub, sideways, profile, 12, hub - sideways * 0.064, hub + sideways * 0.064);
}

/// A toothed ring with two sections per tooth.
void add_gear(MeshBuilder& builder, Vec3d center, double radius, double ring_height, std::uint32_t teeth) {
  constexpr double tooth_height = 0.005;
  std::vector<Section> sections;
  for (std::uint32_t i = 0; i < 2 * teeth; ++i) {
    const Vec3d outward = direction_at(static_cast<double>(i) / (2 * teeth));
    const double outer = radius + (i % 2 == 0 ? tooth_height : -tooth_height);
    const double inner = radius - tooth_height - ring_height;
    sections.push_back(rectangle(center + outward * ((outer + inner) / 2), sideways * 0.0022,
                                 outward * ((outer - inner) / 2)));
  }
  builder.add_loop(sections, 4);
}

/// The closed line that the chain follows around both gears.
std::vector<Vec3d> chain_path() {
  const Vec3d to_front = bottom_bracket - rear_hub;
  constexpr int steps = 2048;
  std::vector<Vec3d> path;
  for (int i = 0; i <= steps; ++i) {
    // The outline of the convex hull of two discs: in each direction, take the disc that extends further.
    const Vec3d normal = direction_at(static_cast<double>(i % steps) / steps);
    const bool front = dot(to_front, normal) + chainring_radius > sprocket_radius;
    path.push_back(
        at_side((front ? bottom_bracket : rear_hub) + normal * (front ? chainring_radius : sprocket_radius),
                chain_z));
  }
  return path;
}

/// Links are blocks of 8 vertices, alternately wide and narrow, that overlap at the pins.
void add_chain(MeshBuilder& builder) {
  constexpr std::uint32_t links = 112;
  const std::vector<Vec3d> pins = resample(chain_path(), links + 1);
  for (std::uint32_t link = 0; link < links; ++link) {
    const Vec3d start = pins[link];
    const Vec3d end = pins[link + 1];
    const Vec3d along = unit(end - start);
    const Vec3d across = cross(sideways, along);
    const double half_width = link % 2 == 0 ? 0.0048 : 0.0030;
    const Vec3d overhang = along * 0.0035;
    const std::array<Section, 2> sections{rectangle(start - overhang, across * 0.0042, sideways * half_width),
                                          rectangle(end + overhang, across * 0.0042, sideways * half_width)};
    builder.add_loft(sections, 4);
  }
}

/// Adds eight closed parts.
void add_frame(MeshBuilder& builder) {
  const Vec3d head_axis = unit(head_high - head_low);
  const Vec3d seat_axis = unit(seat_cluster - bottom_bracket);
  builder.add_bar(seat_cluster - seat_axis * 0.02, head_high - head_axis * 0.030, 0.0155, 0.0155, 22, 8);
  builder.add_bar(bottom_bracket, head_low + head_axis * 0.035, 0.0185, 0.0175, 24, 8);
  builder.add_bar(bottom_bracket, seat_cluster + seat_axis * 0.025, 0.0165, 0.0165, 20, 8);
  builder.add_bar(head_low, head_high, 0.0205, 0.0205, 8, 12);
  for (const double side : {1.0, -1.0}) {
    const std::array<Vec3d, 4> chain_stay{at_side(bottom_bracket + Vec3d{-0.010, 0.002, 0}, 0.022 * side),
                                          at_side(bottom_bracket + Vec3d{-0.080, 0.010, 0}, 0.030 * side),
                                          at_side(lerp(bottom_bracket, rear_hub, 0.6), 0.047 * side),
                                          at_side(rear_hub, 0.056 * side)};
    add_curved_tube(builder, chain_stay, 0.012, 0.0075, 20, 7);
    const std::array<Vec3d, 4> seat_stay{at_side(seat_cluster + Vec3d{-0.004, -0.004, 0}, 0.016 * side),
                                         at_side(lerp(seat_cluster, rear_hub, 0.2), 0.027 * side),
                                         at_side(lerp(seat_cluster, rear_hub, 0.6), 0.046 * side),
                                         at_side(rear_hub, 0.056 * side)};
    add_curved_tube(builder, seat_stay, 0.009, 0.0075, 22, 7);
  }
}

/// Adds two blades and a crown.
void add_fork(MeshBuilder& builder) {
  const Vec3d head_axis = unit(head_high - head_low);
  const Vec3d crown = head_low - head_axis * 0.012;
  for (const double side : {1.0, -1.0}) {
    const std::array<Vec3d, 4> blade{at_side(crown, 0.034 * side),
                                     at_side(crown - head_axis * 0.14, 0.042 * side),
                                     at_side(crown - head_axis * 0.29 + Vec3d{0.004, 0, 0}, 0.050 * side),
                                     at_side(front_hub, 0.056 * side)};
    add_curved_tube(builder, blade, 0.0135, 0.0075, 20, 8);
  }
  builder.add_bar(crown - sideways * 0.044, crown + sideways * 0.044, 0.0165, 0.0165, 6, 10);
}

/// Adds the stem, the drop bar and two brake levers.
void add_handlebar(MeshBuilder& builder) {
  const Vec3d head_axis = unit(head_high - head_low);
  const Vec3d stem_top = head_high + head_axis * 0.050;
  const Vec3d clamp = stem_top + Vec3d{0.095, 0.012, 0};
  const std::array<Vec3d, 4> stem{head_high + head_axis * 0.004, stem_top - head_axis * 0.012,
                                  stem_top + Vec3d{0.016, 0.006, 0}, clamp + Vec3d{0.012, 0.001, 0}};
  add_curved_tube(builder, stem, 0.0145, 0.0165, 9, 9);

  // One half of the bar, from the clamp to the end of the drop.
  const std::array<Vec3d, 9> half{clamp,
                                  clamp + Vec3d{0, 0, 0.100},
                                  clamp + Vec3d{0.004, 0, 0.175},
                                  clamp + Vec3d{0.035, 0.002, 0.205},
                                  clamp + Vec3d{0.080, -0.006, 0.210},
                                  clamp + Vec3d{0.108, -0.050, 0.212},
                                  clamp + Vec3d{0.090, -0.100, 0.214},
                                  clamp + Vec3d{0.040, -0.128, 0.216},
                                  clamp + Vec3d{-0.035, -0.132, 0.218}};
  std::vector<Vec3d> bar;
  for (std::size_t i = half.size(); i-- > 1;) bar.push_back(mirrored(half[i]));
  bar.insert(bar.end(), half.begin(), half.end());
  add_curved_tube(builder, bar, 0.0125, 0.0125, 64, 8);

  for (const double side : {1.0, -1.0}) {
    const std::array<Vec3d, 5> lever{at_side(clamp + Vec3d{0.085, 0.000, 0}, 0.211 * side),
                                     at_side(clamp + Vec3d{0.118, 0.030, 0}, 0.211 * side),
                                     at_side(clamp + Vec3d{0.136, 0.002, 0}, 0.211 * side),
                                     at_side(clamp + Vec3d{0.138, -0.048, 0}, 0.212 * side),
                                     at_side(clamp + Vec3d{0.124, -0.092, 0}, 0.213 * side)};
    add_curved_tube(builder, lever, 0.0140, 0.0050, 12, 6);
  }
}

/// Adds the post, the saddle and two rails.
void add_seat(MeshBuilder& builder) {
  const Vec3d seat_axis = unit(seat_cluster - bottom_bracket);
  const Vec3d post_top = seat_cluster + seat_axis * 0.155;
  builder.add_bar(seat_cluster + seat_axis * 0.01, post_top, 0.0125, 0.0125, 8, 11);

  struct SaddleSection {
    double x, y, half_height, half_width;
  };
  constexpr std::array<SaddleSection, 12> rings{{{-0.140, 0.050, 0.012, 0.040},
                                                 {-0.125, 0.051, 0.018, 0.062},
                                                 {-0.100, 0.049, 0.021, 0.072},
                                                 {-0.070, 0.046, 0.021, 0.068},
                                                 {-0.040, 0.043, 0.020, 0.055},
                                                 {-0.010, 0.041, 0.019, 0.041},
                                                 {0.020, 0.040, 0.018, 0.031},
                                                 {0.050, 0.040, 0.017, 0.025},
                                                 {0.080, 0.040, 0.016, 0.022},
                                                 {0.105, 0.039, 0.015, 0.020},
                                                 {0.125, 0.036, 0.013, 0.016},
                                                 {0.138, 0.031, 0.008, 0.009}}};
  std::vector<Section> sections;
  for (const auto& [x, y, half_height, half_width] : rings)
    sections.push_back({post_top + Vec3d{x, y, 0}, {0, half_height, 0}, {0, 0, half_width}});
  builder.add_loft(sections, 14, post_top + Vec3d{-0.143, 0.050, 0}, post_top + Vec3d{0.142, 0.029, 0});

  for (const double side : {1.0, -1.0}) {
    const std::array<Vec3d, 4> rail{
        post_top + Vec3d{-0.100, 0.038, 0.034 * side}, post_top + Vec3d{-0.035, 0.004, 0.022 * side},
        post_top + Vec3d{0.035, 0.004, 0.016 * side}, post_top + Vec3d{0.100, 0.034, 0.008 * side}};
    add_curved_tube(builder, rail, 0.0045, 0.0045, 10, 6);
  }
}

/// Adds twelve closed parts: the bottom bracket shell, two cranks, two pedals, their two axles, five spider
/// arms.
void add_drive(MeshBuilder& builder) {
  builder.add_bar(bottom_bracket - sideways * 0.036, bottom_bracket + sideways * 0.036, 0.022, 0.022, 4, 12);
  const Vec3d front{0.94, -0.34, 0};
  const Vec3d crank = unit(front) * 0.170;
  for (const double side : {1.0, -1.0}) {
    const Vec3d end = bottom_bracket + crank * side;
    const Vec3d start = at_side(bottom_bracket - crank * (0.1 * side), 0.052 * side);
    const Vec3d outer = at_side(end, 0.066 * side);
    const Vec3d along = unit(outer - start);
    const Vec3d across = unit(cross(sideways, along));
    const Vec3d thick = cross(along, across);
    std::vector<Section> sections;
    for (int i = 0; i < 10; ++i) {
      const double t = i / 9.0;
      sections.push_back({lerp(start, outer, t), across * (0.017 - 0.006 * t), thick * (0.009 - 0.002 * t)});
    }
    builder.add_loft(sections, 8);

    builder.add_bar(at_side(end, 0.060 * side), at_side(end, 0.160 * side), 0.0055, 0.0055, 5, 6);
    std::vector<Section> pedal;
    for (int i = 0; i < 7; ++i) {
      const double z = side * (0.078 + 0.075 * i / 6.0);
      const double half_length = i == 0 || i == 6 ? 0.034 : 0.042;
      pedal.push_back({at_side(end, z), {half_length, 0, 0}, {0, 0.0125 * side, 0}});
    }
    builder.add_loft(pedal, 8);
  }

  const Vec3d spider = at_side(bottom_bracket, chain_z);
  for (int arm = 0; arm < 5; ++arm) {
    const Vec3d outward = direction_at(arm / 5.0 + 0.03);
    const Vec3d across = cross(sideways, outward);
    std::vector<Section> sections;
    for (int i = 0; i < 5; ++i)
      sections.push_back(
          {spider + outward * (0.012 + 0.066 * i / 4.0), across * (0.011 - 0.001 * i), sideways * 0.005});
    builder.add_loft(sections, 6);
  }
  add_gear(builder, spider, chainring_radius, 0.012, 44);
  add_gear(builder, at_side(rear_hub, chain_z), sprocket_radius, 0.014, 18);
  add_chain(builder);
}

/// Adds one closed part: two arms around the tyre, modelled as one bent tube.
void add_brake(MeshBuilder& builder, Vec3d mount, Vec3d toward_rim) {
  const std::array<Vec3d, 7> arc{
      mount + toward_rim * 0.066 - sideways * 0.020, mount + toward_rim * 0.046 - sideways * 0.030,
      mount + toward_rim * 0.018 - sideways * 0.028, mount,
      mount + toward_rim * 0.018 + sideways * 0.028, mount + toward_rim * 0.046 + sideways * 0.030,
      mount + toward_rim * 0.066 + sideways * 0.020};
  add_curved_tube(builder, arc, 0.0075, 0.0075, 14, 6);
}

void add_bottle(MeshBuilder& builder) {
  const Vec3d down = head_low - bottom_bracket;
  const Vec3d axis = unit(down);
  const Vec3d above = cross(sideways, axis);
  const Vec3d bottom = bottom_bracket + down * 0.30 + above * 0.060;
  constexpr std::array<LathePoint, 13> profile{{{0.032, 0.000},
                                                {0.036, 0.006},
                                                {0.036, 0.030},
                                                {0.036, 0.058},
                                                {0.033, 0.066},
                                                {0.033, 0.076},
                                                {0.036, 0.084},
                                                {0.036, 0.110},
                                                {0.035, 0.136},
                                                {0.024, 0.156},
                                                {0.022, 0.168},
                                                {0.011, 0.172},
                                                {0.009, 0.188}}};
  builder.add_lathe(bottom, axis, profile, 12, bottom, bottom + axis * 0.190);
}

}  // namespace

TriangleMesh make_bike() {
  MeshBuilder builder;
  add_wheel(builder, rear_hub);   // 1 hub, besides spokes and rings
  add_wheel(builder, front_hub);  // 1
  add_frame(builder);             // 8
  add_fork(builder);              // 3
  add_handlebar(builder);         // 4
  add_seat(builder);              // 4
  add_drive(builder);             // 12, besides the chain
  add_bottle(builder);            // 1

  const Vec3d head_axis = unit(head_high - head_low);
  const Vec3d rear_mount = lerp(rear_hub, seat_cluster, 0.79) + Vec3d{-0.004, 0, 0};
  add_brake(builder, head_low - head_axis * 0.004 + Vec3d{0.026, 0, 0}, head_axis * -1.0);  // 1
  add_brake(builder, rear_mount, unit(rear_hub - rear_mount));                              // 1
  builder.add_ring(head_low, head_axis, 0.0195, 0.006, 0.005, 12, 5);
  builder.add_ring(head_high, head_axis, 0.0195, 0.006, 0.005, 12, 5);
  return std::move(builder).finish("bike");
}

}  // namespace supple::models
