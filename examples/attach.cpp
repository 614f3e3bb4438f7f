// Shows a program's own scene in a page while the program runs. The page can pause it, take single steps, and
// pause it on events, such as the first contact of two objects. It can colour objects by numbers of the
// program.
//
//   attach [STEPS]: after so many steps, the page shows the last one until it continues the program
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"
#include "supple/viewer.hpp"

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 60;
  supple::Scene scene({.contacts = supple::ContactKinds::penetration});
  const supple::TriangleMesh ball = supple::make_icosphere(8);
  scene.add(supple::make_box({6, 1, 6}, 8), {.name = "floor", .is_static = true, .solid = true});
  const supple::ObjectId bouncing = scene.add(ball, {.name = "ball", .solid = true});
  const supple::ObjectId passing = scene.add(ball, {.name = "other ball", .solid = true});

  try {
    supple::viewer::View view =
        supple::viewer::attach(scene, {.title = "two balls", .time_step = 0.01, .spectators = true});
    std::printf("Open %s\nWatch %s\n", view.url().c_str(), view.watching_url().c_str());
    std::fflush(stdout);
    std::vector<double> heights(ball.positions.size());  // numbers of your own, one for each vertex
    for (int step = 0; step < steps; ++step) {
      // A solver of your own: here one ball bounces, and the other one passes by.
      const double height = supple::sin_turns(0.01 * step + 0.25);
      scene.set_transform(bouncing, {.translation = {-1, 2.4 + height, 0}});
      scene.set_transform(passing, {.translation = {1.5 + 1.2 * supple::sin_turns(0.004 * step), 2.2, 0}});
      for (std::size_t v = 0; v < heights.size(); ++v) heights[v] = ball.positions[v].y + 2.4 + height;
      view.set_field(bouncing, "height", heights);
      scene.detect();  // the page shows this result
    }
    if (argc > 1) view.wait();
    std::printf("%llu steps, %llu frames\n", static_cast<unsigned long long>(view.step_count()),
                static_cast<unsigned long long>(view.frame_count()));
  } catch (const supple::Error& error) {
    std::printf("%s\n", error.what());  // for example, built without the page
  }
}
