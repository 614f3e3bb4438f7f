#include <cstdio>

#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/supple.hpp"

int main() {
  supple::Simulation simulation;
  simulation.add(supple::make_torus(24, 12, 1.0, 0.25));
  simulation.add(supple::make_icosphere(4));
  std::printf("supple %s: %zu contacts\n", SUPPLE_VERSION, simulation.detect().contacts.size());
}
