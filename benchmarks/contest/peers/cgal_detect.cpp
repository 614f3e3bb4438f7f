// The task of `supple detect` implemented with CGAL: read meshes, find intersecting triangles, write them as
// JSON. One mesh is tested against itself, without triangles that share a vertex; two meshes are tested
// against each other.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;

struct Mesh {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  std::vector<Kernel::Triangle_3> triangles;
  std::vector<Box> boxes;

  explicit Mesh(const std::string& path) {
    if (!CGAL::IO::read_polygon_soup(path, points, polygons)) throw std::runtime_error(path + ": not read");
    for (const auto& p : polygons) triangles.emplace_back(points[p[0]], points[p[1]], points[p[2]]);
    for (std::size_t i = 0; i < triangles.size(); ++i) boxes.emplace_back(triangles[i].bbox(), i);
  }
  bool share_vertex(std::size_t i, std::size_t j) const {
    return std::find_first_of(polygons[i].begin(), polygons[i].end(), polygons[j].begin(),
                              polygons[j].end()) != polygons[i].end();
  }
};

int main(int argument_count, char** arguments) {
  if (argument_count < 3 || argument_count > 4) {
    std::cerr << "usage: supple_cgal_detect OUTPUT.json MESH [MESH]\n";
    return 1;
  }
  try {
    Mesh a(arguments[2]);
    std::vector<std::array<std::size_t, 2>> pairs;
    if (argument_count == 3) {
      CGAL::box_self_intersection_d(a.boxes.begin(), a.boxes.end(), [&](const Box& s, const Box& t) {
        const std::size_t i = std::min(s.info(), t.info()), j = std::max(s.info(), t.info());
        if (!a.share_vertex(i, j) && CGAL::do_intersect(a.triangles[i], a.triangles[j]))
          pairs.push_back({i, j});
      });
    } else {
      Mesh b(arguments[3]);
      CGAL::box_intersection_d(a.boxes.begin(), a.boxes.end(), b.boxes.begin(), b.boxes.end(),
                               [&](const Box& s, const Box& t) {
                                 const std::size_t i = s.info(), j = t.info();
                                 if (CGAL::do_intersect(a.triangles[i], b.triangles[j]))
                                   pairs.push_back({i, j});
                               });
    }
    std::sort(pairs.begin(), pairs.end());
    std::ofstream output(arguments[1]);
    output << "{\"pairs\": [";
    for (std::size_t i = 0; i < pairs.size(); ++i)
      output << (i == 0 ? "[" : ",[") << pairs[i][0] << ',' << pairs[i][1] << ']';
    output << "]}\n";
  } catch (const std::exception& error) {
    std::cerr << "supple_cgal_detect: " << error.what() << '\n';
    return 1;
  }
}
