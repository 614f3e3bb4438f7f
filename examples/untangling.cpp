// A ball has cut through a cloth. Each curve of intersection encloses the vertices of the cloth that are on
// the wrong side; moving them back along the normal of the curve untangles the cloth.
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"
#include "supple/use_manifolds.hpp"

int main() {
  supple::use_manifolds();  // the curves are in supple::manifold
  supple::TriangleMesh cloth = supple::make_cloth(40, 40, 2, 2);
  supple::TriangleMesh ball = supple::make_icosphere(12);
  for (supple::Vec3d& p : ball.positions) p = 0.5 * p + supple::Vec3d{0.013, 0.35, 0.017};

  supple::Scene scene({.contacts = supple::ContactKinds::penetration, .curves = true});
  const supple::ObjectId a = scene.add(cloth, {.name = "cloth"});
  scene.add(ball, {.name = "ball", .is_static = true, .solid = true});

  for (int pass = 0; pass < 20; ++pass) {
    const supple::DetectResult& result = scene.detect();
    std::printf("pass %d: %zu curves, %zu intersecting triangles, %zu vertices of the cloth are inside\n",
                pass, result.curves.size(), result.contacts.size(), result.penetrations.size());
    if (result.curves.empty()) return 0;
    for (const supple::IntersectionCurve& curve : result.curves) {
      // The normal points to the cloth's side. The vertices around the curve must move, too.
      std::vector<bool> moves(cloth.positions.size());
      for (const std::uint32_t v : result.enclosed_vertices_of(curve, supple::ContactSide::a))
        moves[v] = true;
      for (const std::uint32_t i : result.contacts_of(curve)) {
        for (const std::uint32_t v : scene.vertices_of(result.contacts[i], supple::ContactSide::a))
          moves[v] = true;
      }
      for (std::size_t v = 0; v < moves.size(); ++v) {
        if (moves[v]) cloth.positions[v] += (0.5 * curve.depth + 1e-3) * curve.normal;
      }
    }
    scene.set_positions(a, cloth.positions);
  }
  return 1;
}
