#include <array>
#include <span>
#include <utility>
#include <vector>

#include "built_in.hpp"
#include "mesh_builder.hpp"

namespace supple::models {
namespace {

struct BodySection {
  double x, y, half_height, half_width;
};

/// 12 rings of 10 vertices and two poles, nose towards +x: 122 vertices.
void add_body(MeshBuilder& builder) {
  constexpr std::array<BodySection, 12> rings{{
      {-0.315, 0.012, 0.046, 0.014},
      {-0.270, 0.010, 0.056, 0.026},
      {-0.205, 0.008, 0.088, 0.042},
      {-0.130, 0.004, 0.128, 0.060},
      {-0.045, 0.000, 0.163, 0.076},
      {0.050, 0.000, 0.185, 0.088},
      {0.145, 0.000, 0.190, 0.095},
      {0.235, -0.002, 0.175, 0.094},
      {0.315, -0.006, 0.145, 0.085},
      {0.385, -0.012, 0.108, 0.069},
      {0.440, -0.018, 0.070, 0.048},
      {0.475, -0.022, 0.036, 0.026},
  }};
  std::vector<Section> sections;
  for (const auto& [x, y, half_height, half_width] : rings)
    sections.push_back({{x, y, 0}, {0, half_height, 0}, {0, 0, half_width}});
  builder.add_loft(sections, 10, Vec3d{-0.33, 0.012, 0}, Vec3d{0.485, -0.024, 0});
}

/// A low dome whose flat side lies inside the head: 13 vertices.
void add_eye(MeshBuilder& builder, double side) {
  const Vec3d center{0.375, 0.035, 0.060 * side};
  const Vec3d outward = unit({0.25, 0.15, side});
  constexpr std::array<LathePoint, 2> profile{{{0.027, 0.0}, {0.022, 0.014}}};
  builder.add_lathe(center, outward, profile, 6, {}, center + outward * 0.022);
}

/// Adds a fin and its mirror image. The arguments describe the fin on the right side, at +z.
void add_paired_fin(MeshBuilder& builder, std::span<const Vec3d> root, std::span<const Vec3d> edge,
                    bool left) {
  if (!left) return builder.add_strip(root, edge);
  std::vector<Vec3d> left_root;
  std::vector<Vec3d> left_edge;
  for (const Vec3d& p : root) left_root.push_back(mirrored(p));
  for (const Vec3d& p : edge) left_edge.push_back(mirrored(p));
  builder.add_strip(left_root, left_edge);
}

}  // namespace

// The fish swims towards +x. It has 338 faces and 216 vertices: three closed parts and seven fins.
TriangleMesh make_fish() {
  MeshBuilder builder;
  add_body(builder);
  add_eye(builder, 1);
  add_eye(builder, -1);

  // The fins are open sheets with every vertex on the border: 68 vertices, 54 faces.
  constexpr std::array<Vec3d, 8> tail_root{{{-0.430, 0.230, 0},
                                            {-0.375, 0.165, 0},
                                            {-0.325, 0.095, 0},
                                            {-0.296, 0.040, 0},
                                            {-0.296, -0.018, 0},
                                            {-0.325, -0.075, 0},
                                            {-0.375, -0.145, 0},
                                            {-0.430, -0.210, 0}}};
  constexpr std::array<Vec3d, 8> tail_edge{{{-0.515, 0.255, 0},
                                            {-0.480, 0.170, 0},
                                            {-0.450, 0.095, 0},
                                            {-0.425, 0.040, 0},
                                            {-0.425, -0.018, 0},
                                            {-0.450, -0.075, 0},
                                            {-0.480, -0.150, 0},
                                            {-0.515, -0.235, 0}}};
  builder.add_strip(tail_edge, tail_root);

  constexpr std::array<Vec3d, 7> back{{{0.205, 0.172, 0},
                                       {0.145, 0.183, 0},
                                       {0.085, 0.181, 0},
                                       {0.025, 0.174, 0},
                                       {-0.035, 0.160, 0},
                                       {-0.095, 0.138, 0},
                                       {-0.150, 0.113, 0}}};
  constexpr std::array<Vec3d, 7> back_edge{{{0.170, 0.235, 0},
                                            {0.100, 0.300, 0},
                                            {0.030, 0.310, 0},
                                            {-0.035, 0.290, 0},
                                            {-0.090, 0.258, 0},
                                            {-0.145, 0.222, 0},
                                            {-0.205, 0.190, 0}}};
  builder.add_strip(back, back_edge);

  constexpr std::array<Vec3d, 5> belly{{{-0.060, -0.152, 0},
                                        {-0.100, -0.134, 0},
                                        {-0.140, -0.115, 0},
                                        {-0.175, -0.097, 0},
                                        {-0.210, -0.078, 0}}};
  constexpr std::array<Vec3d, 5> belly_edge{{{-0.085, -0.215, 0},
                                             {-0.130, -0.240, 0},
                                             {-0.175, -0.225, 0},
                                             {-0.215, -0.190, 0},
                                             {-0.250, -0.150, 0}}};
  builder.add_strip(belly_edge, belly);

  constexpr std::array<Vec3d, 4> breast{
      {{0.250, -0.020, 0.088}, {0.242, -0.050, 0.085}, {0.232, -0.080, 0.078}, {0.222, -0.108, 0.068}}};
  constexpr std::array<Vec3d, 4> breast_edge{
      {{0.140, -0.020, 0.165}, {0.105, -0.065, 0.180}, {0.110, -0.115, 0.172}, {0.140, -0.150, 0.150}}};
  constexpr std::array<Vec3d, 3> pelvis{
      {{0.105, -0.172, 0.030}, {0.070, -0.170, 0.028}, {0.035, -0.165, 0.026}}};
  constexpr std::array<Vec3d, 3> pelvis_edge{
      {{0.055, -0.235, 0.075}, {0.005, -0.255, 0.085}, {-0.025, -0.225, 0.070}}};
  for (const bool left : {false, true}) {
    add_paired_fin(builder, breast, breast_edge, left);
    add_paired_fin(builder, pelvis, pelvis_edge, left);
  }
  return std::move(builder).finish("fish");
}

}  // namespace supple::models
