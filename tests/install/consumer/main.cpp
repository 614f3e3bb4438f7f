#include <cstdio>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  supple::Scene scene;
  scene.add(supple::make_torus(24, 12, 1.0, 0.25));
  scene.add(supple::make_icosphere(4));
  std::printf("supple %s: %zu contacts\n", SUPPLE_VERSION, scene.detect().contacts.size());
}
