#include <cstdio>

#include "supple/recording.hpp"
#include "supple/supple.hpp"

int main() {
  supple::Recorder recorder("consumer.h5", {});
  recorder.add(0.5, {}, {});
  recorder.close();
  const supple::Recording recording("consumer.h5");
  std::printf("supple %s: frame at %g s\n", SUPPLE_VERSION, recording.frame(0).time);
}
