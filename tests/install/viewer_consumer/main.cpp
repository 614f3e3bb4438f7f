// Attaches a scene, or says that the library was built without the page.
#include <cstdio>

#include "supple/supple.hpp"
#include "supple/viewer.hpp"

int main() {
  supple::Scene scene;
  try {
    const supple::viewer::View view = supple::viewer::attach(scene, {.open_browser = false});
    scene.detect();
    std::printf("supple %s: %d step\n", SUPPLE_VERSION, static_cast<int>(view.step_count()));
  } catch (const supple::Error& error) {
    std::printf("supple %s: %s\n", SUPPLE_VERSION, error.what());
  }
}
