// The list of contestants. A library that was not found defines none.

#include "contest/peers/peers.hpp"

namespace supple::benchmarks {

std::vector<Entry<BoxContestant>> other_box_contestants() {
  std::vector<Entry<BoxContestant>> entries;
  entries.push_back({"baseline sweep", make_baseline_sweep});
  entries.push_back({"baseline grid", make_baseline_grid});
#ifdef SUPPLE_CONTEST_EMBREE
  entries.push_back({"Embree", make_embree_boxes});
#endif
#ifdef SUPPLE_CONTEST_CGAL
  entries.push_back({"CGAL", make_cgal_boxes});
#endif
#ifdef SUPPLE_CONTEST_FCL
  entries.push_back({"FCL", make_fcl_boxes, 100'000});
#endif
#ifdef SUPPLE_CONTEST_BULLET
  entries.push_back({"Bullet", make_bullet_boxes, 100'000});
#endif
#ifdef SUPPLE_CONTEST_ODE
  entries.push_back({"ODE", make_ode_boxes, 100'000});
#endif
  return entries;
}

std::vector<Entry<CopiesContestant>> other_copies_contestants() {
  std::vector<Entry<CopiesContestant>> entries;
#ifdef SUPPLE_CONTEST_EMBREE
  entries.push_back({"Embree", make_embree_copies});
  entries.push_back({"Embree, contact points", make_embree_copies_with_points});
#endif
#ifdef SUPPLE_CONTEST_CGAL
  entries.push_back({"CGAL", make_cgal_copies});
#endif
#ifdef SUPPLE_CONTEST_BULLET
  entries.push_back({"Bullet", make_bullet_copies});
#endif
#ifdef SUPPLE_CONTEST_FCL
  entries.push_back({"FCL", make_fcl_copies, 1'200'000});
#endif
  return entries;
}

std::vector<Entry<ClothContestant>> other_cloth_contestants() {
  std::vector<Entry<ClothContestant>> entries;
#ifdef SUPPLE_CONTEST_EMBREE
  entries.push_back({"Embree", make_embree_cloth});
#endif
#ifdef SUPPLE_CONTEST_CGAL
  entries.push_back({"CGAL", make_cgal_cloth});
#endif
  return entries;
}

std::vector<Entry<Contestant<ClothStep>>> other_near_cloth_contestants([[maybe_unused]] double margin) {
  std::vector<Entry<Contestant<ClothStep>>> entries;
#ifdef SUPPLE_CONTEST_EMBREE
  entries.push_back({"Embree", [margin] { return make_embree_near_cloth(margin); }});
#endif
  return entries;
}

std::vector<Entry<QueryContestant>> other_query_contestants() {
  std::vector<Entry<QueryContestant>> entries;
#ifdef SUPPLE_CONTEST_EMBREE
  entries.push_back({"Embree", make_embree_queries});
#endif
#ifdef SUPPLE_CONTEST_CGAL
  entries.push_back({"CGAL", make_cgal_queries});
#endif
#ifdef SUPPLE_CONTEST_FCL
  entries.push_back({"FCL", make_fcl_queries});
#endif
  return entries;
}

std::vector<std::string> missing_libraries() {
  std::vector<std::string> missing;
#ifndef SUPPLE_CONTEST_EMBREE
  missing.emplace_back("Embree");
#endif
#ifndef SUPPLE_CONTEST_CGAL
  missing.emplace_back("CGAL");
#endif
#ifndef SUPPLE_CONTEST_FCL
  missing.emplace_back("FCL");
#endif
#ifndef SUPPLE_CONTEST_BULLET
  missing.emplace_back("Bullet");
#endif
#ifndef SUPPLE_CONTEST_ODE
  missing.emplace_back("ODE");
#endif
  return missing;
}

}  // namespace supple::benchmarks
