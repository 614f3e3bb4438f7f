#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <stop_token>
#include <utility>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/simulation.hpp"

namespace supple::observer_test {

TEST(Observer, SeesEachResultOfDetect) {
  Scene scene;
  const ObjectId ball = scene.add(make_icosphere(1));
  std::vector<std::uint64_t> steps;
  scene.set_observer([&](const Scene& seen, const DetectRequest& request) {
    EXPECT_TRUE(seen.contains(ball));
    EXPECT_EQ(request.max_contacts, 7u);
    steps.push_back(seen.result().step);
  });
  scene.detect({.max_contacts = 7});
  Scene moved = std::move(scene);
  moved.detect({.max_contacts = 7});
  EXPECT_EQ(steps, (std::vector<std::uint64_t>{0, 1}));
  moved.set_observer({});
  moved.detect();
  EXPECT_EQ(steps.size(), 2u);
}

TEST(Observer, DoesNotSeeAStoppedCall) {
  Scene scene;
  scene.add(make_icosphere(4));
  int seen = 0;
  scene.set_observer([&](const Scene&, const DetectRequest&) { ++seen; });
  std::stop_source stop;
  stop.request_stop();
  DetectRequest request;
  request.stop = stop.get_token();
  EXPECT_TRUE(scene.detect(request).stopped);
  EXPECT_EQ(seen, 0);
}

TEST(Observer, WhatItThrowsLeavesDetectAndTheResultStays) {
  Scene scene;
  scene.add(make_icosphere(1));
  scene.detect();
  scene.set_observer([](const Scene&, const DetectRequest&) { throw std::runtime_error("observer"); });
  EXPECT_THROW(scene.detect(), std::runtime_error);
  EXPECT_EQ(scene.result().step, 1u);
  EXPECT_FALSE(scene.result().stopped);
}

TEST(Observer, SeesTheStepsOfASimulation) {
  Simulation simulation;
  simulation.add(make_icosphere(1), {}, RigidMotion{.velocity = {1, 0, 0}});
  int seen = 0;
  simulation.set_observer([&](const Scene&, const DetectRequest&) { ++seen; });
  simulation.step();
  simulation.step();
  EXPECT_EQ(seen, 2);
}

TEST(OptionsOfObject, HaveLaterChanges) {
  Scene scene;
  const ObjectId ball = scene.add(make_icosphere(1), {.name = "ball", .margin = 0.5});
  scene.set_options(ball, {.margin = 0.25});
  scene.set_options(ball, {.is_static = true});
  EXPECT_EQ(scene.options(ball).name, "ball");
  EXPECT_EQ(scene.options(ball).margin, 0.25);
  EXPECT_TRUE(scene.options(ball).is_static);
  scene.remove(ball);
  EXPECT_THROW(scene.options(ball), Error);
}

}  // namespace supple::observer_test
